//! Writes a scene as one Wavefront mesh with light-map coordinates, for bakers that read nothing else: `export_obj -- SCENE SIDE OUT.obj [MESH]`.
//!
//! Positions, normals and the second texture coordinates, v as it stands (row 0 of a sheet lies at v = 0). Coordinates that the scene lacks are
//! made, one sheet of SIDE texels for all; with a number MESH only that mesh is written, alone in its sheet.

#![expect(clippy::print_stdout, reason = "an example that tells what it wrote")]

mod named;

use scene::lightmap::{Density, Unwrap, faults, unwrap};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene_name, side, out, ..] = &arguments[..] else {
        return Err("give: export_obj -- SCENE SIDE OUT.obj [MESH]".into());
    };
    let mut scene = named::scene(scene_name)?;
    let sheet: Vec<usize> = match arguments.get(3) {
        Some(mesh) => vec![mesh.parse()?],
        None => (0..scene.meshes.len()).collect(),
    };
    if sheet.iter().any(|&m| m >= scene.meshes.len()) {
        return Err(format!("the scene has {} meshes, from 0", scene.meshes.len()).into());
    }
    if sheet.iter().any(|&m| scene.meshes[m].uv1.is_empty()) {
        let start = Instant::now();
        let options = Unwrap { density: Density::Side(side.parse()?), ..Unwrap::default() };
        let atlas = unwrap(&mut scene, &sheet, &options, &|_, _, _| ())?;
        println!(
            "unwrapped in {:.1} s: {} x {} texels, {} charts, {:.0} % filled, {} triangles lost",
            start.elapsed().as_secs_f64(),
            atlas.width,
            atlas.height,
            atlas.charts,
            100.0 * atlas.filled,
            atlas.lost
        );
    } else {
        println!("the scene's own coordinates, {} faults", faults(&scene, &sheet).len());
    }
    let mut file = BufWriter::new(File::create(out)?);
    let mut base = 1;
    for &m in &sheet {
        let mesh = &scene.meshes[m];
        writeln!(file, "o {}", mesh.name.replace(' ', "_"))?;
        for ((p, n), uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uv1) {
            writeln!(file, "v {} {} {}\nvt {} {}\nvn {} {} {}", p.x, p.y, p.z, uv.x, uv.y, n.x, n.y, n.z)?;
        }
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| v + base);
            writeln!(file, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")?;
        }
        base += mesh.positions.len() as u32;
    }
    println!("{} meshes, {} vertices", sheet.len(), base - 1);
    Ok(file.flush()?)
}
