//! Prints how far light maps are from paths through bent normals, basis by basis: `normal_mapping -- SCENE PROBE BANDS SIZE PATHS [F.prt VIEW]`.
//!
//! Without a file, a scene that brings coordinates for one sheet is baked; a file must hold the windowed light of the probe in so many
//! bands (`relume bake --storage texture --lighting fixed --basis sh9 --bands N`). SIZE is such as 320x240, PATHS per pixel,
//! VIEW eye x,y,z, target x,y,z and degrees. The figures of `docs/normal-mapping.md`.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

#[path = "../tests/mapped/mod.rs"]
mod mapped;
mod named;
#[path = "../tests/support/mod.rs"]
#[expect(unused_imports, reason = "only its light is used")]
mod support;

use coeff_io::{Bounces, Camera, Prt, Quality};
use mapped::{Shot, Truth, baked, drawn, windowed};
use sh_math::Rgb;
use sh_math::hemisphere::Basis;
use std::path::Path;

/// Texels along a side of the sheet of a scene that is baked here, and rays of each texel.
const BAKED: (u32, Quality) = (256, Quality::Rays(4096));

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene_name, probe_name, bands, size, paths, ..] = &arguments[..] else {
        return Err("give: normal_mapping -- SCENE PROBE BANDS SIZE PATHS [F.prt VIEW]".into());
    };
    let (scene, environment) = (named::scene(scene_name)?, named::probe(probe_name)?);
    let light = windowed(&environment, bands.parse()?);
    let mut prt = match arguments.get(5) {
        Some(file) => Prt::read(Path::new(file))?,
        None => baked(&scene, &light, BAKED.0, BAKED.1, Bounces::Auto),
    };
    // The path tracer knows no reflections.
    prt.materials.iter_mut().for_each(|material| material.specular = false);
    let (width, height) = size.split_once('x').ok_or("the size is WxH")?;
    let shot = Shot {
        camera: arguments.get(6).map_or_else(|| Ok(prt.cameras[0].clone()), |view| camera(view))?,
        size: [width.parse()?, height.parse()?],
        samples: (paths.parse::<u32>()? / 2).max(2),
        max_bounces: (prt.settings.bounces != Bounces::Auto).then_some(prt.achieved.bounces),
    };
    let truth = Truth::trace(&scene, &light, &shot);
    table(&prt, &light, &shot, &truth);
    ranges(&prt, &light);
    flat(scene, prt, &light, &shot);
    Ok(())
}

/// How far the coefficients of modified H 6 go beyond the constant: the paper's rule of thumb is 0.75 of it at most.
fn ranges(prt: &Prt, light: &Rgb) {
    let Some(maps) = &prt.maps else { return };
    let mut ratios = Vec::new();
    for sheet in &maps.sheets {
        let (_, lit) = maps.lit_in(sheet, light, Basis::ModifiedH6);
        let Some((first, others)) = lit.functions.split_first().filter(|(_, others)| !others.is_empty()) else {
            continue;
        };
        for (texel, constant) in first.iter().enumerate() {
            for (c, &constant) in constant.iter().enumerate().filter(|(_, constant)| **constant > 0.0) {
                ratios.push(others.iter().map(|other| other[texel][c].abs()).fold(0.0, f32::max) / constant);
            }
        }
    }
    ratios.sort_by(f32::total_cmp);
    if ratios.is_empty() {
        return;
    }
    // The largest says nothing: somewhere the constant is all but 0.
    let beyond = ratios.iter().filter(|ratio| **ratio > 0.75).count();
    println!(
        "modified H 6, largest coefficient over the constant: beyond 0.75 in {:.1} %, 99 % below {:.2}",
        100.0 * beyond as f64 / ratios.len() as f64,
        ratios[ratios.len() * 99 / 100]
    );
}

/// The same without normal maps: how far one function of three bands is from the light map that it stands for, and what errs in any basis.
fn flat(mut scene: scene::Scene, mut prt: Prt, light: &Rgb, shot: &Shot) {
    scene.materials.iter_mut().for_each(|material| material.normal_texture = None);
    prt.materials.iter_mut().for_each(|material| material.normal_texture = None);
    let truth = Truth::trace(&scene, light, shot);
    for basis in [Some(Basis::ModifiedH1), Some(Basis::Sh9), None] {
        if basis.is_none() {
            prt.maps = None;
        }
        let f = truth.judge(&drawn(&prt, light, shot, basis));
        let ([rms, bias], name) = ([f.rms, f.bias].map(|share| 100.0 * share), basis.map_or("vertices", Basis::name));
        println!("{name} without normal maps: RMS error {rms:.2} %, mean error {bias:+.2} %");
    }
}

fn table(prt: &Prt, light: &Rgb, shot: &Shot, truth: &Truth) {
    println!("| basis | bytes of a texel, f16 | RMS error | mean error | 99 % of the pixels below | RMS from SH 9 |");
    println!("|---|---|---|---|---|---|");
    let nine = drawn(prt, light, shot, Basis::Sh9);
    let mut said = String::new();
    for basis in Basis::ALL {
        let drawing = drawn(prt, light, shot, basis);
        let f = truth.judge(&drawing);
        let bytes = 6 * basis.count();
        let [rms, bias, p99, apart] = [f.rms, f.bias, f.p99, drawing.apart(&nine)].map(|share| 100.0 * share);
        println!("| {} | {bytes} | {rms:.2} % | {bias:+.2} % | {p99:.0} % | {apart:.2} % |", basis.name());
        said = format!("{} pixels; noise of the reference {:.2} %, taken off the RMS", f.pixels, 100.0 * f.noise);
    }
    println!("\n{said}");
}

fn camera(view: &str) -> Result<Camera, Failure> {
    let numbers: Vec<f32> = view.split(',').map(|number| number.trim().parse()).collect::<Result<_, _>>()?;
    let [ex, ey, ez, tx, ty, tz, fov] = numbers[..] else {
        return Err("a view has seven numbers".into());
    };
    let (eye, target, up) = ([ex, ey, ez], [tx, ty, tz], [0.0, 1.0, 0.0]);
    Ok(Camera { name: "view".into(), eye, target, up, vertical_fov: fov.to_radians() })
}
