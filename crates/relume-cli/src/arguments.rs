//! What may be typed: the commands and the options that all of them take.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches};
use std::error::Error;

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

/// Reads the command line; ends the program with the reason where it is wrong.
pub(crate) fn parse() -> Arguments {
    let matches = command().try_get_matches().unwrap_or_else(|error| worded(error).exit());
    Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
}

/// The commands, whose options take a minus before a number as a value: it is a wrong value more often than an option.
fn command() -> clap::Command {
    fn signed(command: clap::Command) -> clap::Command {
        let takes = |arg: &clap::Arg| arg.get_action().takes_values() && !arg.is_positional();
        let signed_arg = |arg: clap::Arg| if takes(&arg) { arg.allow_negative_numbers(true) } else { arg };
        command.mut_args(signed_arg).mut_subcommands(signed)
    }
    signed(Arguments::command())
}

/// The error with what is to be done, where clap has the words of a programmer.
fn worded(error: clap::Error) -> clap::Error {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        _ => String::new(),
    };
    let said = error.source().map(|source| better(&source.to_string()));
    let (ErrorKind::ValueValidation, Some(Some(better))) = (error.kind(), said) else { return error };
    let (value, name) = (text(ContextKind::InvalidValue), text(ContextKind::InvalidArg));
    command().error(ErrorKind::ValueValidation, format!("invalid value '{value}' for '{name}': {better}"))
}

/// What to do instead of a complaint of a parser of numbers; none for our own sentences.
fn better(complaint: &str) -> Option<String> {
    let whole = "give a whole number";
    Some(match complaint {
        "invalid digit found in string" | "cannot parse integer from empty string" => whole.into(),
        "number would be zero for non-zero type" => format!("{whole} above 0"),
        "number too large to fit in target type" | "number too small to fit in target type" => {
            "that number is out of all range".into()
        }
        "invalid float literal" | "cannot parse float from empty string" => "give a number, such as 0.5".into(),
        other => {
            let (least, most) = other.split_once(" is not in ")?.1.split_once("..")?;
            match most.strip_prefix('=').unwrap_or(most) {
                "" | "4294967295" | "18446744073709551615" => format!("{whole} from {least} on"),
                most => format!("{whole} from {least} to {most}"),
            }
        }
    })
}

const EXAMPLES: &str = "\
Examples:
  relume bake builtin:atrium -o atrium.prt
  relume render atrium.prt --probe builtin:sky -o atrium.png
  relume render atrium.prt --probe kitchen.hdr --rotate 90,0,0 -o kitchen.exr

`relume list` names the built-in scenes and light probes.";

#[cfg(test)]
mod tests {
    /// clap's own check of names, conflicts and defaults.
    #[test]
    fn the_command_line_is_consistent() {
        super::command().debug_assert();
    }

    #[test]
    fn complaints_say_what_to_do() {
        let said = |text: &str| super::better(text).unwrap_or_default();
        assert_eq!(said("0 is not in 1..=1024"), "give a whole number from 1 to 1024");
        assert_eq!(said("-5 is not in 0..=4294967295"), "give a whole number from 0 on");
        // As the standard library has them today.
        let [digit, zero] = ["1k".parse::<u32>().map(drop), "0".parse::<std::num::NonZeroU32>().map(drop)];
        assert_eq!(said(&digit.unwrap_err().to_string()), "give a whole number");
        assert_eq!(said(&zero.unwrap_err().to_string()), "give a whole number above 0");
        assert_eq!(said(&"50%".parse::<f32>().unwrap_err().to_string()), "give a number, such as 0.5");
        assert_eq!(said("give auto or off"), "");
    }
}
