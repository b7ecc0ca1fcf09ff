//! A picture by path tracing.

use crate::camera::View;
use crate::receiver::{Estimate, average};
use crate::world::Seen;
use crate::{Light, Settings, World, path};
use glam::Vec3;
use rayon::prelude::*;
use sampling::rng::Rng;
use scene::Camera;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

/// Linear radiance with its noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB radiance, row by row from the top.
    pub pixels: Vec<[f32; 3]>,
    /// Standard error of each pixel.
    pub std_error: Vec<[f32; 3]>,
}

/// Draws the scene with the sky behind; pixels are averaged over their square. Runs on all threads, to the same bits on
/// any number of them.
///
/// `progress` hears the finished share after each row, from any thread; where it breaks, none is returned.
#[must_use]
pub fn render(
    world: &World,
    light: &Light,
    camera: &Camera,
    [width, height]: [u32; 2],
    settings: &Settings,
    progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
) -> Option<Picture> {
    let view = View::new(camera, width, height);
    let finished = AtomicU32::new(0);
    let row = |y: u32| {
        let row: Vec<Estimate> = (0..width).map(|x| pixel(world, light, &view, [x, y, width], settings)).collect();
        let share = (finished.fetch_add(1, Ordering::Relaxed) + 1) as f32 / height as f32;
        progress(share).is_continue().then_some(row)
    };
    let rows: Vec<Vec<Estimate>> = (0..height).into_par_iter().map(row).collect::<Option<_>>()?;
    let pixels = rows.iter().flatten().map(|pixel| pixel.mean).collect();
    let std_error = rows.iter().flatten().map(|pixel| pixel.std_error).collect();
    Some(Picture { width, height, pixels, std_error })
}

/// Mean radiance over the square of the pixel in column `x` and row `y`.
fn pixel(world: &World, light: &Light, view: &View, [x, y, width]: [u32; 3], settings: &Settings) -> Estimate {
    let mut rng = Rng::new(settings.seed, u64::from(y) * u64::from(width) + u64::from(x));
    average(settings.samples, || {
        let [dx, dy] = rng.next_square();
        let direction = view.direction([x as f32 + dx, y as f32 + dy]);
        arriving(world, light, view.eye, direction, settings.max_bounces, &mut rng)
    })
}

/// Radiance that arrives at the camera from a direction.
pub(crate) fn arriving(
    world: &World,
    light: &Light,
    eye: Vec3,
    direction: Vec3,
    max_bounces: Option<u32>,
    rng: &mut Rng,
) -> Vec3 {
    match world.seen(eye, direction, rng) {
        Some(Seen { unlit: Some(color), .. }) => color,
        Some(seen) => seen.emission + path::outgoing(world, light, seen.surface, max_bounces, rng),
        None => light.sky(direction),
    }
}
