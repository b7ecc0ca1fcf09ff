//! `relume uv`: whether a scene's light-map coordinates serve, and how the program would unwrap it.

use crate::columns::{Columns, Side, terminal_width, wrap};
use crate::console::Console;
use crate::output;
use crate::picture::{self, Size, Target};
use crate::source::SceneOptions;
use anyhow::{Result, bail};
use scene::lightmap::{self, Atlas, Charts, Density, Fault, FaultKind, Unwrap};
use scene::{Mesh, Scene};
use serde_json::{Value, json};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume uv house.glb
  relume uv house.glb --sheet mesh --image house-uv.png
  relume uv builtin:teacup --unwrap --texels-per-metre 200 --image teacup-uv.png

Looks at the second texture coordinates. Ends with status 1 where a triangle lies outside of the unit square, \
upon another, folded, without area or without coordinates; where a chart has less than four texels or none between \
itself and another; and where less than a twentieth of the sheet is used. Of each the first fault is told, with mesh \
and number. --unwrap shows how the scene would be cut and how dense its sheet would be; it writes no scene. The \
picture shows each chart in a colour of its own.";

const COLUMNS: Columns =
    Columns(&[(34, Side::Left), (9, Side::Right), (7, Side::Right), (7, Side::Right), (8, Side::Right)]);
/// Faults that are listed one by one unless more are asked for.
const LISTED: usize = 12;
const LARGEST_SIDE: i64 = 8192;

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    scene: SceneOptions,
    /// Which meshes share a sheet, so that they must not lie upon each other.
    #[arg(long, value_enum, default_value_t = SheetName::Scene)]
    sheet: SheetName,
    /// Try coordinates of the program's own, in one sheet for all meshes.
    #[arg(long, conflicts_with = "sheet")]
    unwrap: bool,
    /// Density of what is unwrapped.
    #[arg(long, value_name = "D", requires = "unwrap", conflicts_with = "texels", value_parser = density)]
    texels_per_metre: Option<f32>,
    /// Columns of the sheet: of what is looked at or unwrapped, and of the picture.
    #[arg(long, alias = "size", value_name = "N", default_value_t = 1024,
          value_parser = clap::value_parser!(u32).range(16..=LARGEST_SIDE))]
    texels: u32,
    /// Free texels around each chart of what is unwrapped.
    #[arg(long, value_name = "N", default_value_t = 2, requires = "unwrap", value_parser = clap::value_parser!(u32).range(0..=64))]
    padding: u32,
    /// A picture of the sheet: .png. With `--sheet mesh`, all sheets upon each other.
    #[arg(long, alias = "layout", value_name = "FILE", value_parser = png)]
    image: Option<Target>,
    /// List every fault.
    #[arg(long)]
    all: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum SheetName {
    /// All meshes of the scene share one sheet.
    Scene,
    /// Each mesh has a sheet of its own.
    Mesh,
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    options.image.as_ref().map_or(Ok(()), |target| output::check(&target.path, &options.scene.files()))?;
    let mut scene = options.scene.load(console)?;
    options.image.as_ref().map_or(Ok(()), |target| output::check(&target.path, &scene.files))?;
    let all: Vec<usize> = (0..scene.meshes.len()).collect();
    let atlas = if options.unwrap { Some(unwrap(&mut scene, &all, &options.as_unwrap(), console)?) } else { None };
    let size = atlas.map_or([options.texels; 2], |atlas| [atlas.width, atlas.height]);
    let mut faults: Vec<Fault> = match options.sheet {
        SheetName::Scene => all_faults(&scene, &all, size),
        SheetName::Mesh => all.iter().flat_map(|&mesh| all_faults(&scene, &[mesh], size)).collect(),
    };
    if options.unwrap {
        // They have no place, which is counted, and can have none.
        faults.retain(|fault| fault.kind != FaultKind::Flat);
    }
    if let Some(target) = &options.image {
        let size = atlas.map_or(Size { width: options.texels, height: options.texels }, |atlas| Size {
            width: atlas.width,
            height: atlas.height,
        });
        draw(&scene, &all, size, target)?;
    }
    console.print(&if options.json {
        as_json(&scene, atlas.as_ref(), &faults)
    } else {
        as_text(&scene, atlas.as_ref(), &faults, if options.all { usize::MAX } else { LISTED })
    })?;
    match faults.len() {
        0 => {
            console.next(&format!("{} --storage maps", options.scene.bake_command()));
            Ok(())
        }
        1 => bail!("{}: 1 fault in the light-map coordinates", scene.name),
        n => bail!("{}: {n} faults in the light-map coordinates", scene.name),
    }
}

/// What is wrong with the coordinates of meshes that share a sheet, whatever its size and at this size.
fn all_faults(scene: &Scene, sheet: &[usize], size: [u32; 2]) -> Vec<Fault> {
    let mut faults = lightmap::faults(scene, sheet);
    faults.extend(lightmap::crowding(scene, sheet, size));
    faults.sort_by_key(|fault| (fault.mesh, fault.triangle));
    faults
}

fn unwrap(scene: &mut Scene, sheet: &[usize], options: &Unwrap, console: &Console) -> Result<Atlas> {
    let progress = console.progress();
    progress.expect(&[("cutting charts", 1.0), ("placing charts", 1.0)]);
    Ok(lightmap::unwrap(scene, sheet, options, &|stage, done, total| progress.set(stage, done, total))?)
}

/// Parses a density.
fn density(text: &str) -> Result<f32, String> {
    let value = text.parse().ok().filter(|density| (1e-6..=1e6).contains(density));
    value.ok_or_else(|| "give texels to a metre from 0.000001 to 1000000, such as 20".into())
}

/// Parses the name of a picture for the display.
fn png(text: &str) -> Result<Target, String> {
    let is_png = text.to_ascii_lowercase().ends_with(".png");
    if is_png { picture::target(text) } else { Err("give a file that ends in .png".into()) }
}

impl Options {
    fn as_unwrap(&self) -> Unwrap {
        let density = self.texels_per_metre.map_or(Density::Side(self.texels), Density::PerMetre);
        Unwrap { density, padding: self.padding }
    }
}

fn as_text(scene: &Scene, atlas: Option<&Atlas>, faults: &[Fault], most: usize) -> String {
    let mut text = String::new();
    if let Some(atlas) = atlas {
        text.push_str(&format!(
            "{} x {} texels, {:.4} to a metre, {} charts, {:.0} % of the sheet filled, {} triangles too thin for a place\n\n",
            atlas.width,
            atlas.height,
            atlas.texels_per_metre,
            atlas.charts,
            100.0 * atlas.filled,
            atlas.lost
        ));
    }
    text.push_str(&COLUMNS.row(&["mesh", "triangles", "charts", "faults", "of sheet"]));
    for (index, mesh) in scene.meshes.iter().enumerate() {
        let told = faults.iter().filter(|fault| fault.mesh == index).count();
        text.push_str(&COLUMNS.row(&[
            &mesh.name,
            &mesh.triangles.len().to_string(),
            &charts(mesh).to_string(),
            &told.to_string(),
            &format!("{:.1} %", 100.0 * lightmap::share(mesh)),
        ]));
    }
    if !faults.is_empty() {
        text.push('\n');
    }
    for fault in faults.iter().take(most) {
        text.push_str(&(wrap(&sentence(scene, fault), terminal_width() - 2).join("\n  ") + "\n"));
    }
    if faults.len() > most {
        text.push_str(&format!("and {} more (--all lists them)\n", faults.len() - most));
    }
    text
}

fn sentence(scene: &Scene, fault: &Fault) -> String {
    let name = |index: usize| {
        let mesh = &scene.meshes[index];
        format!("mesh {index} '{}' ({})", mesh.name, scene.materials[mesh.material as usize].name)
    };
    match fault.kind {
        FaultKind::Missing => format!("{}: {} (--unwrap shows what they could be)\n", name(fault.mesh), fault.kind),
        FaultKind::Overlaps { mesh, triangle } => {
            format!(
                "{}, triangle {}: it lies upon triangle {triangle} of {}\n",
                name(fault.mesh),
                fault.triangle,
                name(mesh)
            )
        }
        FaultKind::Touches { mesh, triangle } => {
            format!(
                "{}, triangle {}: its chart has no free texel to that of triangle {triangle} of {}\n",
                name(fault.mesh),
                fault.triangle,
                name(mesh)
            )
        }
        FaultKind::Sparse(_) => format!("{}: {}\n", name(fault.mesh), fault.kind),
        kind => format!("{}, triangle {}: {kind}\n", name(fault.mesh), fault.triangle),
    }
}

fn as_json(scene: &Scene, atlas: Option<&Atlas>, faults: &[Fault]) -> String {
    let meshes: Vec<Value> = scene.meshes.iter().map(|mesh| {
        json!({ "name": mesh.name, "triangles": mesh.triangles.len(), "charts": charts(mesh), "share": lightmap::share(mesh) })
    }).collect();
    let faults: Vec<Value> = faults
        .iter()
        .map(|fault| {
            let mut value = json!({ "mesh": fault.mesh, "triangle": fault.triangle, "what": fault.kind.to_string() });
            if let FaultKind::Overlaps { mesh, triangle } | FaultKind::Touches { mesh, triangle } = fault.kind {
                value["other"] = json!({ "mesh": mesh, "triangle": triangle });
            }
            value
        })
        .collect();
    let atlas = atlas.map(|atlas| {
        json!({
            "width": atlas.width, "height": atlas.height, "texels_per_metre": atlas.texels_per_metre,
            "charts": atlas.charts, "filled": atlas.filled, "lost": atlas.lost,
        })
    });
    format!("{:#}", json!({ "scene": scene.name, "atlas": atlas, "meshes": meshes, "faults": faults }))
}

/// Charts of a mesh that has coordinates.
fn charts(mesh: &Mesh) -> u32 {
    if mesh.uv1.is_empty() { 0 } else { Charts::of(mesh).count }
}

/// Draws the texels that surfaces touch, each chart in a colour of its own; darker where the middle lies outside.
fn draw(scene: &Scene, sheet: &[usize], size: Size, target: &Target) -> Result<()> {
    let charts: Vec<Charts> = scene.meshes.iter().map(Charts::of).collect();
    let count = size.width as usize * size.height as usize;
    let mut display = vec![[24, 24, 28, 255]; count];
    for texel in lightmap::texels(scene, sheet, size.width, size.height) {
        let chart = charts[texel.mesh as usize].of_triangle[texel.triangle as usize];
        let shade = if texel.is_middle { 1.0 } else { 0.6 };
        let [r, g, b] = colour(texel.mesh, chart).map(|x| (255.0 * shade * x) as u8);
        display[texel.row as usize * size.width as usize + texel.column as usize] = [r, g, b, 255];
    }
    // A PNG has no use for radiance.
    target.write(size, &[], &display)
}

/// A bright colour for a chart; neighbours in number differ.
fn colour(mesh: u32, chart: u32) -> [f32; 3] {
    // The golden ratio spreads hues evenly.
    let hue = 6.0 * ((f64::from(mesh) * 0.381_966 + f64::from(chart) * 0.618_034).fract() as f32);
    [0.0, 4.0, 2.0].map(|shift| 0.35 + 0.6 * (((hue + shift) % 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0))
}
