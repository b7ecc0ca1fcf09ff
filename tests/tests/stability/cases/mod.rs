//! The hard cases by theme: what must hold, what ours reaches, what the naive method gives.
#![allow(dead_code, reason = "the tests and the table each use a part")]

pub(crate) mod albedo;
mod baking;
mod case;
pub(crate) mod evaluation;
pub(crate) mod furnace;
mod listing;
pub(crate) mod normals;
pub(crate) mod probes;
mod published;
pub(crate) mod ranges;
pub(crate) mod ringing;
pub(crate) mod rotation;
pub(crate) mod scales;
pub(crate) mod suns;
pub(crate) mod terminator;
pub(crate) mod triangles;
pub(crate) mod walls;

pub(crate) use case::Case;

/// Hands all cases to a macro, theme by theme, in the order of the table.
macro_rules! hard_cases {
    ($take:ident) => {
        $take! {
            evaluation { next_to_the_poles, degree_100_in_f32, degree_128, degree_1024, orthonormal_21_bands }
            rotation {
                gimbal, half_turns, tiny_turns, degree_128, turned_directions, ten_thousand_turns,
                length_after_ten_thousand_turns, composition_and_inverse,
            }
            ringing { bare_sun, energy_of_a_sun, many_suns }
            suns { sun_of_1e5, sun_of_1e6, files_keep_suns }
            furnace { hundred_bounces, clamped_cosine }
            scales { tiny_scene, huge_scene, far_scene }
            triangles { slivers, zero_area, coincident_faces, duplicated_vertices, single_triangle, empty_meshes }
            normals { inverted, not_a_number }
            walls { sealed_box, corners_of_a_box, paper_walls, thin_gap, buried_receivers }
            terminator { twelve_sided_sphere, split_sphere }
            albedo { above_one, reported }
            probes { not_a_number, negative, one_pixel, behind_the_angular_map }
            ranges { transfer_in_8_bit, clipped_transfer, grazing_light }
        }
    };
}
pub(crate) use hard_cases;
