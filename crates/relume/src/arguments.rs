//! What may be typed: the commands and the options that all of them take.

use crate::{bake, bases, cost, export, inspect, light, plan, reference, render, uv};

/// Bakes how a scene answers to light, and relights it under any light probe.
#[derive(Debug, clap::Parser)]
#[command(name = "relume", version, propagate_version = true, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Threads to work with; all that the machine has by default.
    #[arg(long, global = true, help_heading = "General", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Say nothing but errors and what was asked for.
    #[arg(short, long, global = true, help_heading = "General", conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say more of what is being done.
    #[arg(short, long, global = true, help_heading = "General")]
    pub(crate) verbose: bool,
}

/// One file per command holds its options and its work.
#[derive(Debug, clap::Subcommand)]
pub(crate) enum Command {
    /// Tell which effects a scene calls for, why, and what each will cost.
    #[command(after_help = plan::EXAMPLES)]
    Plan(plan::Options),
    /// Bake how a scene answers to light.
    #[command(after_help = bake::EXAMPLES)]
    Bake(bake::Options),
    /// Draw a baked file under a light probe.
    #[command(after_help = render::EXAMPLES)]
    Render(render::Options),
    /// Draw the ground truth by path tracing.
    #[command(after_help = reference::EXAMPLES)]
    Reference(reference::Options),
    /// Tell what a baked file holds and check it.
    #[command(after_help = inspect::EXAMPLES)]
    Inspect(inspect::Options),
    /// Write the coefficients of a baked file for other programs.
    #[command(after_help = export::EXAMPLES)]
    Export(export::Options),
    /// Write the spherical harmonics coefficients of a light probe.
    #[command(after_help = light::EXAMPLES)]
    Light(light::Options),
    /// Measure what accuracy costs on a scene, and recommend settings.
    #[command(after_help = cost::EXAMPLES)]
    Cost(cost::Options),
    /// Compare the bases of irradiance normal mapping: error, time, bytes.
    #[command(after_help = bases::EXAMPLES)]
    Bases(bases::Options),
    /// Check the light-map coordinates of a scene, or try how it would unwrap.
    #[command(after_help = uv::EXAMPLES)]
    Uv(uv::Options),
    /// Name the built-in scenes and light probes.
    List,
}

const EXAMPLES: &str = "\
Examples:
  relume bake builtin:atrium -o atrium.prt
  relume render atrium.prt --probe builtin:sky -o atrium.png
  relume render atrium.prt --probe kitchen.hdr --rotate 90,0,0 -o kitchen.exr

`relume list` names the built-in scenes and light probes.";

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    /// clap's own check of names, conflicts and defaults.
    #[test]
    fn the_command_line_is_consistent() {
        super::Arguments::command().debug_assert();
    }
}
