//! Occlusion and closest hits in a triangle soup.
//!
//! ```
//! use glam::{Vec3, vec3};
//! use raytrace::{Ray, Tracer};
//!
//! let positions = [vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
//! let tracer = Tracer::build(&positions, &[[0, 1, 2]], &[]);
//! let ray = Ray::new(vec3(0.25, 0.25, 2.0), Vec3::NEG_Z);
//! let hit = tracer.closest(&ray, &|_, _, _| true).expect("the triangle is in the way");
//! assert_eq!((hit.triangle, hit.t, hit.front), (0, 2.0, true));
//! assert!(tracer.occluded(&ray, &|_, _, _| true));
//! ```

mod above;
mod binary;
mod block;
mod build;
mod closest_fan;
mod depth;
mod exact;
mod fan;
mod flat;
mod found;
mod group;
mod lanes;
mod level;
mod meetings;
mod nearest;
mod offset;
mod packet;
mod ray;
mod scratch;
mod screen;
mod search;
mod sight;
mod tracer;
mod tree;
mod under;
mod validate;
mod walk;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use fan::FanState;
pub use level::Level;
pub use offset::{offset_origin, offset_origin_on};
pub use ray::{Hit, Ray};
pub use tracer::Tracer;
