//! Draws the figures on glossy materials beside the path tracer, and prints how far each picture is from it: `figures -- FOLDER [PATHS] [NAME...]`.
//!
//! NAME is tessellation, bounces, normal-maps or exponents ([T] figures 4 to 8). The pictures and figures of `docs/glossy.md`.

#![expect(clippy::print_stdout, reason = "an example that prints figures")]

#[path = "../tests/glossy/mod.rs"]
mod glossy;

use coeff_io::{GlossView, Refine};
use glossy::{Recipe, Shot, Truth, baked, drawn, traced};
use probe_io::Environment;
use scene::Scene;
use sh_math::lobe::{Lobe, roughness_of_exponent};
use std::path::Path;
use study::plot::pixels::Pixels;

type Failure = Box<dyn std::error::Error>;
type Linear = Vec<[f32; 3]>;

/// Columns and rows of each picture.
const SIZE: [u32; 2] = [320, 200];

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = arguments.first().ok_or("give: figures -- FOLDER [PATHS] [NAME...]")?;
    let paths = arguments.get(1).map_or(Ok(128), |text| text.parse())?;
    let wanted = |name: &str| arguments.len() <= 2 || arguments[2..].iter().any(|a| a == name);
    let draw = Draw { folder: Path::new(folder), paths };
    std::fs::create_dir_all(folder)?;
    if wanted("tessellation") {
        draw.tessellation()?;
    }
    if wanted("bounces") {
        draw.bounces()?;
    }
    if wanted("normal-maps") {
        draw.normal_maps()?;
    }
    if wanted("exponents") {
        draw.exponents()?;
    }
    Ok(())
}

struct Draw<'a> {
    folder: &'a Path,
    paths: u32,
}

impl Draw<'_> {
    /// Figure 4: a ground of few triangles, with gloss at vertices, at vertices of a finer mesh, and at texels.
    fn tessellation(&self) -> Result<(), Failure> {
        let (scene, light) = (builtin("paper-plants")?, probe("studio")?);
        let shot = shot(0, GlossView::default());
        let truth = self.truth(&scene, &light, &shot, 1, false);
        let recipe = Recipe { bounces: 1, bent: false, ..Recipe::standard() };
        let coarse = Recipe { refine: Refine::Off, ..recipe };
        // Light between surfaces comes from vertices: these are split all the same.
        let texels = Recipe { texels: Some(512), ..recipe };
        let mut row = Vec::new();
        for (name, recipe) in [("vertices as they are", coarse), ("vertices, split", recipe), ("texels", texels)] {
            let prt = baked(&scene, &recipe, None);
            let picture = drawn(&prt, &light, &shot);
            println!(
                "tessellation | {name} | {} vertices | {:.4}",
                prt.geometry.positions.len(),
                truth.difference(&picture)
            );
            row.push(picture);
        }
        row.push(truth.picture());
        self.write("glossy-tessellation", &[row])
    }

    /// Figure 5: without bounces and with, under one light as the paper has them and relit.
    fn bounces(&self) -> Result<(), Failure> {
        let (scene, light) = (builtin("paper-room")?, probe("studio")?);
        let shot = shot(0, GlossView::default());
        let mut rows = Vec::new();
        for bounces in [0, 2] {
            let truth = self.truth(&scene, &light, &shot, bounces, true);
            let recipe = Recipe { bounces, texels: Some(256), ..Recipe::standard() };
            let relit = baked(&scene, &recipe, None);
            let held = bake::FixedLight { name: light.name.clone(), coefficients: coefficients(&light) };
            let fixed = baked(&scene, &recipe, Some(held));
            let openness = baked(&scene, &Recipe { glossy: false, ..recipe }, None);
            let mut row = Vec::new();
            for (name, prt) in [("openness", &openness), ("fixed light", &fixed), ("relit", &relit)] {
                let picture = drawn(prt, &light, &shot);
                let bytes = prt.achieved.gloss.map_or(0, |gloss| gloss.bytes[1]);
                println!("{bounces} bounces | {name} | {bytes} bytes | {:.4}", truth.difference(&picture));
                row.push(picture);
            }
            row.push(truth.picture());
            rows.push(row);
        }
        self.write("glossy-bounces", &rows)
    }

    /// Figure 6: two triangles with a normal map.
    fn normal_maps(&self) -> Result<(), Failure> {
        let (scene, light) = (builtin("paper-room")?, probe("studio")?);
        let shot = shot(1, GlossView::default());
        let truth = self.truth(&scene, &light, &shot, 1, true);
        let mut row = Vec::new();
        for (name, texels) in [("256 texels", 256), ("1024 texels", 1024)] {
            let recipe =
                Recipe { bounces: 1, rays: 256, texels: Some(texels), refine: Refine::Off, ..Recipe::standard() };
            let picture = drawn(&baked(&scene, &recipe, None), &light, &shot);
            println!("normal maps | {name} | {:.4}", truth.difference(&picture));
            row.push(picture);
        }
        row.push(truth.picture());
        self.write("glossy-normal-maps", &[row])
    }

    /// Figures 7 and 8: exponents of Phong in columns, lights in rows; below each row that of the path tracer.
    fn exponents(&self) -> Result<(), Failure> {
        let scene = builtin("paper-heads")?;
        let recipe = Recipe { bounces: 0, rays: 256, bent: false, ..Recipe::standard() };
        let prt = baked(&scene, &recipe, None);
        let mut rows = Vec::new();
        for name in ["studio", "sky"] {
            let light = probe(name)?;
            let (mut ours, mut theirs) = (Vec::new(), Vec::new());
            for exponent in [5.0, 10.0, 20.0, 50.0] {
                let roughness = Some(roughness_of_exponent(exponent) as f32);
                let view = GlossView { lobe: Lobe::Phong, roughness, ..GlossView::default() };
                let shot = shot(0, view);
                let truth = self.truth(&scene, &light, &shot, 0, false);
                let with = drawn(&prt, &light, &shot);
                let without = drawn(&prt, &light, &Shot { view: GlossView { tail: false, ..view }, ..shot });
                println!(
                    "{name} | exponent {exponent} | with tail {:.4} | without {:.4}",
                    truth.difference(&with),
                    truth.difference(&without)
                );
                ours.push(with);
                theirs.push(truth.picture());
            }
            rows.extend([ours, theirs]);
        }
        self.write("glossy-exponents", &rows)
    }

    fn truth(&self, scene: &Scene, light: &Environment, shot: &Shot, bounces: u32, bent: bool) -> Truth {
        traced(scene, light, shot, (self.paths, bounces, bent))
    }

    /// Rows of pictures side by side as one PNG.
    fn write(&self, name: &str, rows: &[Vec<Linear>]) -> Result<(), Failure> {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
        let (width, height) = (columns * SIZE[0], rows.len() as u32 * SIZE[1]);
        let mut rgba = vec![[0, 0, 0, 255]; (width * height) as usize];
        for (r, row) in rows.iter().enumerate() {
            for (c, picture) in row.iter().enumerate() {
                for (k, pixel) in picture.iter().enumerate() {
                    let (x, y) =
                        (c * SIZE[0] as usize + k % SIZE[0] as usize, r * SIZE[1] as usize + k / SIZE[0] as usize);
                    let [red, green, blue] = pixel.map(display);
                    rgba[y * width as usize + x] = [red, green, blue, 255];
                }
            }
        }
        let path = self.folder.join(format!("{name}.png"));
        std::fs::write(&path, Pixels { width, height, rgba }.png()?)?;
        println!("wrote {}", path.display());
        Ok(())
    }
}

/// Reinhard's curve and sRGB, in 8 bits.
fn display(x: f32) -> u8 {
    let x = x.max(0.0);
    let curved = coeff_io::srgb_of_linear(x / (1.0 + x));
    (255.0 * curved + 0.5) as u8
}

fn shot(camera: usize, view: GlossView) -> Shot {
    Shot { camera, size: SIZE, view }
}

fn coefficients(light: &Environment) -> Vec<[f32; 3]> {
    let bands = sh_math::Bands::new(9).expect("nine bands");
    sh_math::project(bands, light.samples()).values
}

fn builtin(name: &str) -> Result<Scene, Failure> {
    Ok(scene::builtin(name).ok_or("no such scene")?)
}

fn probe(name: &str) -> Result<Environment, Failure> {
    Ok(probe_io::builtin(name).ok_or("no such probe")?)
}
