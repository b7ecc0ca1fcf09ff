//! Scenes with known answers, made by code, shared by tests, goldens, benches and demos.
//!
//! Each file states the closed forms beside its geometry. All are for diffuse surfaces of albedo a
//! under a sky of radiance 1 unless stated; visibility functions give the cosine-weighted share of
//! the upper hemisphere that sees the sky, so that direct radiance = a times the share.

mod atrium;
mod boxes;
mod bumps;
mod paper;
mod patch;
mod planes;
mod rooms;
mod round;
mod teacup;

use crate::Scene;

pub use paper::PAPER_SCENES;
pub use planes::{facing_planes_share, half_blocked_plane_share, sphere_on_plane_share};
pub use round::bowl_radiance;

/// Name and one-line description of every built-in scene with a known answer; tests walk all of them. [`PAPER_SCENES`] are built in, too.
pub const BUILTINS: &[(&str, &str)] = &[
    ("furnace-box", "closed cube, albedo 0.5: radiance 0.5 under a sky of 1, for any number of bounces"),
    ("closed-room", "closed cube seen from inside: black under every sky"),
    ("two-rooms", "an open room beside a sealed one behind a thin wall: black in there under every sky"),
    ("plane", "one square under the open sky: the unshadowed transfer"),
    ("half-blocked-plane", "a black wall on a plane hides an exactly known share of the sky"),
    ("facing-planes", "two squares that face each other: exactly known form factors"),
    ("sphere-on-plane", "a sphere resting on a plane: its shadow is 1 - (r/d)^3"),
    ("bumps", "a ball over a plane with a bumpy normal map and light-map coordinates"),
    ("sphere", "one sphere under the open sky: every receiver is unshadowed"),
    ("bowl", "half an integrating sphere: a geometric series of bounces"),
    ("cornell-box", "red and green walls, two blocks, light from the front and a roof opening"),
    ("teacup", "a glazed cup with handle on a saucer, with tea"),
    ("atrium", "a small court with columns, arches, a gallery roof and coloured walls"),
];

/// The built-in scene of that name (without the `builtin:` prefix); `None` if there is none.
pub fn builtin(name: &str) -> Option<Scene> {
    Some(match name {
        "furnace-box" => boxes::furnace_box(),
        "closed-room" => boxes::closed_room(),
        "two-rooms" => rooms::two_rooms(),
        "plane" => planes::plane(),
        "half-blocked-plane" => planes::half_blocked_plane(),
        "facing-planes" => planes::facing_planes(),
        "sphere-on-plane" => planes::sphere_on_plane(),
        "bumps" => bumps::bumps(),
        "sphere" => round::sphere(),
        "bowl" => round::bowl(),
        "cornell-box" => boxes::cornell_box(),
        "teacup" => teacup::teacup(),
        "atrium" => atrium::atrium(),
        _ => return paper::builtin(name),
    })
}
