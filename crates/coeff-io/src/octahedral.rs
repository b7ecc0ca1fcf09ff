//! The sphere upon a square: the octahedron that its eight octants make, unfolded.
//!
//! A direction is divided by the sum of its magnitudes; where z is negative the corner of the octant is turned outward. `(x, y)` in
//! [-1, 1] then stand along columns and rows, texel `i` of `n` at `(2 i + 1) / n - 1`. The axes are those of the world, +z is the centre.

use glam::{Vec2, Vec3};

/// The unit direction (world axes) that the centre of a texel of a map of `side x side` texels stands for.
#[must_use]
pub fn direction(side: u32, row: u32, column: u32) -> Vec3 {
    let place = |i: u32| (2 * i + 1) as f32 / side as f32 - 1.0;
    of_square(Vec2::new(place(column), place(row)))
}

/// The unit direction at a place in [-1, 1]^2.
#[must_use]
pub fn of_square(place: Vec2) -> Vec3 {
    on_octahedron(place).normalize()
}

/// The point of the octahedron `|x| + |y| + |z| = 1` at a place in [-1, 1]^2.
#[must_use]
pub fn on_octahedron(place: Vec2) -> Vec3 {
    let z = 1.0 - place.x.abs() - place.y.abs();
    let fold = (-z).max(0.0);
    let unfolded = |v: f32| v - fold.copysign(v);
    Vec3::new(unfolded(place.x), unfolded(place.y), z)
}

/// The place in [-1, 1]^2 of a direction of any length but 0.
#[must_use]
pub fn to_square(direction: Vec3) -> Vec2 {
    let d = direction / (direction.x.abs() + direction.y.abs() + direction.z.abs());
    if d.z >= 0.0 {
        return Vec2::new(d.x, d.y);
    }
    Vec2::new((1.0 - d.y.abs()).copysign(d.x), (1.0 - d.x.abs()).copysign(d.y))
}

/// The two numbers of a map `[row][column][2]` of `side x side` texels towards a direction, between the four nearest texels; beyond an edge
/// lies the same edge turned about its middle, as on the octahedron.
#[must_use]
pub fn look_up(map: &[f32], side: u32, towards: Vec3) -> [f32; 2] {
    let side = side as i32;
    let place = (to_square(towards) + 1.0) * 0.5 * side as f32 - 0.5;
    let corner = place.floor();
    let share = place - corner;
    let mut sum = [0.0; 2];
    for i in 0..4 {
        let [dx, dy] = [i & 1, i >> 1];
        let (mut x, mut y) = (corner.x as i32 + dx, corner.y as i32 + dy);
        if x < 0 || x >= side {
            (x, y) = (x.clamp(0, side - 1), side - 1 - y);
        }
        if y < 0 || y >= side {
            (x, y) = (side - 1 - x, y.clamp(0, side - 1));
        }
        let weight = [1.0 - share.x, share.x][dx as usize] * [1.0 - share.y, share.y][dy as usize];
        let at = 2 * (y * side + x) as usize;
        sum = [sum[0] + weight * map[at], sum[1] + weight * map[at + 1]];
    }
    sum
}
