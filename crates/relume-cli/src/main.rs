//! The command line: parse, call one library function, print.

mod arguments;
mod bake;
mod bases;
mod bases_scene;
mod bounces;
mod columns;
mod console;
mod cost;
mod draw;
mod enclosure;
mod export;
mod extras;
mod gloss;
mod gloss_look;
mod inspect;
mod inspect_gloss;
mod inspect_maps;
mod inspect_words;
mod interpolation;
mod interrupt;
mod lens;
mod light;
mod light_facts;
mod list;
mod look;
mod maps;
mod meter;
mod mistake;
mod output;
mod picture;
mod plan;
mod progress;
mod reference;
mod render;
mod settings;
mod sheets;
mod silence;
mod source;
mod usage;
mod uv;
mod visitor;
mod volume;

use arguments::{Arguments, Command};
use console::Console;
use std::process::ExitCode;
use std::time::Instant;
use usage::Usage;

fn main() -> ExitCode {
    let began = Instant::now();
    // First of all: whatever follows may be interrupted.
    let watched = interrupt::watch();
    let arguments = arguments::parse();
    let console = Console::new(arguments.quiet, arguments.verbose, began);
    match watched.and_then(|()| run(&arguments, &console)) {
        Ok(()) => ExitCode::SUCCESS,
        // A reader that has seen enough, such as `head`, is no failure.
        Err(error) if console::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // Folders that were made for results that did not come.
            coeff_io::abandon();
            console.error(&error);
            ExitCode::from(if error.is::<Usage>() { 2 } else { 1 })
        }
    }
}

fn run(arguments: &Arguments, console: &Console) -> anyhow::Result<()> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global()?;
    }
    match &arguments.command {
        Command::Plan(options) => plan::run(options, console),
        Command::Bake(options) => bake::run(options, console),
        Command::Render(options) => render::run(options, console),
        Command::Reference(options) => reference::run(options, console),
        Command::Inspect(options) => inspect::run(options, console),
        Command::Export(options) => export::run(options, console),
        Command::Cost(options) => cost::run(options, console),
        Command::Light(options) => light::run(options, console),
        Command::Bases(options) => bases::run(options, console),
        Command::Uv(options) => uv::run(options, console),
        Command::List => list::run(console),
    }
}
