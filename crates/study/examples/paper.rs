//! Prints the two tables of the paper on transfer textures: `paper -- [--size WxH] [--texels N] [--rays N] [--seconds S] [SCENE...]`.
//!
//! Frames per second are of whatever Vulkan driver is there; on a software driver only their ratios say something. `cargo xtask bench --paper`
//! runs it.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example that prints tables")]

use render_wgpu::{Driver, Gpu};
use std::time::Duration;
use study::paper::{Memory, Setup, baked, memory_table, rate_table, rates, receivers};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|at| arguments.get(at + 1));
    let number = |name: &str, or: u32| option(name).map_or(Ok(or), |text| text.parse());
    let size = option("--size").map_or("1920x1080", String::as_str);
    let (width, height) = size.split_once('x').ok_or("the size is WxH")?;
    let size = [width.parse()?, height.parse()?];
    let setup = Setup { rays: number("--rays", 32)?, texels: number("--texels", 1024)?, ..Setup::paper() };
    let enough = Duration::from_secs(u64::from(number("--seconds", 5)?));
    let named: Vec<&String> = arguments
        .iter()
        .enumerate()
        .filter(|(i, a)| !a.starts_with("--") && (*i == 0 || !arguments[i - 1].starts_with("--")))
        .map(|(_, a)| a)
        .collect();
    let scenes: Vec<&str> = match named.is_empty() {
        true => scene::PAPER_SCENES.iter().map(|(name, _)| *name).collect(),
        false => named.into_iter().map(String::as_str).collect(),
    };
    let environment = probe_io::builtin("studio").ok_or("no built-in light")?;
    let gpu = Gpu::new(Driver::Any)?;
    println!("{}, {}x{}, {:?}", gpu.description(), size[0], size[1], setup);
    let (mut measured, mut memory) = (Vec::new(), Vec::new());
    let mut all = Vec::new();
    for name in scenes {
        let baked = baked(name, &setup)?;
        eprintln!(
            "{name}: unwrapped in {:.1} s, baked at texels in {:.1} s, {} receivers at vertices, {} at texels",
            baked.took[0].as_secs_f64(),
            baked.took[1].as_secs_f64(),
            receivers(&baked.at_vertices),
            receivers(&baked.at_texels)
        );
        memory.push(Memory::of_baked(&baked, setup.bands, setup.texels));
        let found = rates(&gpu, &baked, &environment, size, enough, &mut |rate| {
            eprintln!(
                "  {} {:?} {} turns={}: {:.2}/s",
                rate.camera,
                rate.stage,
                rate.way.name(),
                rate.turns,
                rate.per_second
            );
        })?;
        measured.push(found);
        all.push(baked);
    }
    let rows: Vec<_> = all.iter().zip(measured).collect();
    println!("\nFrames per second\n\n{}", rate_table(&rows));
    println!("Bytes of glossy transfer\n\n{}", memory_table(&memory));
    Ok(())
}
