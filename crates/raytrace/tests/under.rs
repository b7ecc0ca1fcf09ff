//! Fans that leave flat ground of slivers: the answers of single rays, in about the steps that ground of compact triangles takes.
//!
//! Steps are counted, not timed.

mod shapes;

use glam::{Mat3, Quat, Vec3, vec3};
use raytrace::{FanState, Hit, Level, Ray, Tracer, offset_origin};
use shapes::{Random, hemisphere};
use std::f32::consts::TAU;

/// Ground in the plane y = 0 with posts on it; fans leave from its corners and the middles of its edges.
struct Ground {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Triangles of the ground; those of the posts follow.
    flat: usize,
    normal: Vec3,
}

impl Ground {
    fn of(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Ground {
        let mut ground = Ground { flat: triangles.len(), positions, triangles, normal: Vec3::Y };
        for k in 0..12 {
            let angle = k as f32 * 2.4;
            ground.post(vec3(2.0 * angle.sin(), 0.0, 2.0 * angle.cos()) * (k as f32 / 12.0).sqrt());
        }
        ground
    }

    /// A pyramid that stands on the ground.
    fn post(&mut self, at: Vec3) {
        let first = self.positions.len() as u32;
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        self.positions.extend(corners.map(|[x, z]| at + 0.1 * vec3(x, 0.0, z)));
        self.positions.push(at + 0.5 * Vec3::Y);
        self.triangles.extend((0..4).map(|k| [first + k, first + (k + 1) % 4, first + 4]));
    }

    fn rim(n: u32, radius: impl Fn(u32) -> f32) -> Vec<Vec3> {
        (0..n)
            .map(|k| (k as f32 / n as f32 * TAU, radius(k)))
            .map(|(a, r)| vec3(r * a.sin(), 0.0, r * a.cos()))
            .collect()
    }

    /// A disc of slivers around its middle.
    fn disc(n: u32) -> Ground {
        let positions = [Ground::rim(n, |_| 3.0), vec![Vec3::ZERO]].concat();
        Ground::of(positions, (0..n).map(|k| [n, k, (k + 1) % n]).collect())
    }

    /// A convex n-gon, cut into slivers from one of its corners.
    fn polygon(n: u32) -> Ground {
        Ground::of(Ground::rim(n, |_| 3.0), (1..n - 1).map(|k| [0, k, k + 1]).collect())
    }

    /// A star of points on a disc.
    fn star(n: u32) -> Ground {
        let positions = [Ground::rim(n, |k| if k % 2 == 0 { 3.0 } else { 1.5 }), vec![Vec3::ZERO]].concat();
        Ground::of(positions, (0..n).map(|k| [n, k, (k + 1) % n]).collect())
    }

    /// Long teeth side by side.
    fn comb(n: u32) -> Ground {
        let x = |k: u32| 6.0 * k as f32 / n as f32 - 3.0;
        let positions = (0..n).flat_map(|k| [vec3(x(k), 0.0, -3.0), vec3(x(k + 1), 0.0, -3.0), vec3(x(k), 0.0, 3.0)]);
        Ground::of(positions.collect(), (0..n).map(|k| [3 * k, 3 * k + 2, 3 * k + 1]).collect())
    }

    /// Compact triangles, about n of them.
    fn compact(n: u32) -> Ground {
        let side = (n as f32 / 2.0).sqrt() as u32;
        let at = |k: u32| 6.0 * k as f32 / side as f32 - 3.0;
        let m = side + 1;
        let positions = (0..m * m).map(|k| vec3(at(k % m), 0.0, at(k / m))).collect();
        let cells = (0..side * side).map(|k| k % side + k / side * m);
        Ground::of(positions, cells.flat_map(|i| [[i, i + m, i + 1], [i + 1, i + m, i + m + 1]]).collect())
    }

    fn placed(mut self, turn: Mat3, shift: Vec3) -> Ground {
        self.positions.iter_mut().for_each(|p| *p = turn * *p + shift);
        self.normal = turn * self.normal;
        self
    }

    fn tracer(&self) -> Tracer {
        Tracer::build(&self.positions, &self.triangles, &[])
    }

    /// Middles of the edges of every so many triangles, from where fans leave.
    fn origins(&self, count: usize) -> Vec<Vec3> {
        let every = (self.flat / count).max(1);
        let middle = |t: &[u32; 3]| 0.5 * (self.positions[t[0] as usize] + self.positions[t[1] as usize]);
        self.triangles[..self.flat].iter().step_by(every).map(|t| offset_origin(middle(t), self.normal)).collect()
    }

    /// Mean steps of a fan, once the tracer has learned how flat its tree is.
    fn steps(&self) -> f64 {
        let (tracer, origins) = (self.tracer(), self.origins(200));
        let around = hemisphere(self.normal, 64);
        let fans = |state: &mut FanState| origins.iter().for_each(|&o| drop(traced(&tracer, o, &around, state)));
        fans(&mut FanState::new());
        for _ in 0..8 {
            fans(&mut FanState::new());
        }
        let mut state = FanState::new();
        fans(&mut state);
        state.steps() as f64 / origins.len() as f64
    }
}

/// What blocks the rays of a fan.
fn traced(tracer: &Tracer, origin: Vec3, directions: &[Vec3], state: &mut FanState) -> (Vec<bool>, Vec<Option<Hit>>) {
    let axis = |k: usize| directions.iter().map(|d| d[k]).collect::<Vec<f32>>();
    let (xs, ys, zs) = (axis(0), axis(1), axis(2));
    let mut bits = vec![0u64; directions.len().div_ceil(64)];
    tracer.occluded_fan(origin, &xs, &ys, &zs, &|_, _, _| true, state, &mut bits);
    let mut hits = vec![None; directions.len()];
    tracer.closest_fan(origin, &xs, &ys, &zs, &vec![u64::MAX; bits.len()], &|_, _, _| true, state, &mut hits);
    ((0..directions.len()).map(|i| bits[i / 64] >> (i % 64) & 1 == 1).collect(), hits)
}

/// The same, compared with single rays.
fn blocked(tracer: &Tracer, origin: Vec3, directions: &[Vec3], state: &mut FanState) -> Vec<bool> {
    let (bits, hits) = traced(tracer, origin, directions, state);
    for ((bit, hit), d) in bits.iter().zip(&hits).zip(directions) {
        let single = tracer.closest(&Ray::new(origin, *d), &|_, _, _| true);
        assert_eq!((*bit, hit), (single.is_some(), &single), "from {origin} along {d}");
    }
    bits
}

/// A kind of ground by its number of triangles.
type Kind = (&'static str, fn(u32) -> Ground);

const SLIVERS: [Kind; 4] =
    [("disc", Ground::disc), ("polygon", Ground::polygon), ("star", Ground::star), ("comb", Ground::comb)];

fn tilt() -> Mat3 {
    Mat3::from_quat(Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.4, -0.5))
}

/// At most twice the steps of compact triangles, and hardly more for four times the slivers.
#[test]
fn fans_leave_slivers_as_they_leave_compact_triangles() {
    let steps = |kind: fn(u32) -> Ground, n| kind(n).placed(Mat3::IDENTITY, vec3(4.0, 0.0, -7.0)).steps();
    let control = steps(Ground::compact, 4_000);
    for (name, kind) in SLIVERS {
        let (few, many) = (steps(kind, 1_000), steps(kind, 4_000));
        assert!(many < 2.0 * control, "{name}: {many} steps, {control} of compact triangles");
        assert!(many < 1.5 * few + 10.0, "{name}: {few} steps, then {many}");
    }
}

/// Turned, boxes of slivers reach far above their plane, and those that share a part of the tree with a post are opened: their number is
/// that of the posts, not of the slivers. (The thinnest, around a corner, share their parts of the tree with all others.)
#[test]
fn fans_leave_turned_slivers_in_steps_that_hardly_grow() {
    let steps = |kind: fn(u32) -> Ground, n| kind(n).placed(tilt(), vec3(5.0, 2.0, -6.0)).steps();
    for (name, kind) in SLIVERS.into_iter().filter(|(name, _)| *name != "polygon") {
        let (few, many) = (steps(kind, 1_000), steps(kind, 4_000));
        assert!(many < 2.0 * few && many < 500.0, "{name}: {few} steps, then {many}");
    }
}

/// A fan that looks down on slivers opens many boxes: the count above would tell.
#[test]
fn fans_leave_slivers_as_they_leave_compact_triangles_can_fail() {
    let steps = |kind: fn(u32) -> Ground| {
        let mut ground = kind(4_000).placed(tilt(), vec3(5.0, 2.0, -6.0));
        ground.normal = -ground.normal;
        let (tracer, above) = (ground.tracer(), -1e-3 * ground.normal);
        let mut state = FanState::new();
        for origin in ground.origins(50) {
            traced(&tracer, origin + above, &hemisphere(ground.normal, 64), &mut state);
        }
        state.steps()
    };
    let (disc, compact) = (steps(Ground::disc), steps(Ground::compact));
    assert!(disc > 3 * compact, "{disc} steps, {compact}");
}

/// Of the ground itself, from just above, within and just below its plane, into both halves of space.
#[test]
fn answers_are_those_of_single_rays() {
    let mut random = Random::new(5);
    for level in Level::available() {
        for (_, kind) in SLIVERS.into_iter().chain([("compact", Ground::compact as fn(u32) -> Ground)]) {
            for shift in [Vec3::ZERO, vec3(5.0, 2.0, -6.0), vec3(300.0, -20.0, 900.0)] {
                let ground = kind(600).placed(tilt(), shift);
                let tracer = ground.tracer().at_level(level).expect("it is available");
                let mut state = FanState::new();
                let mut seen = [0; 2];
                for round in 0..30 {
                    for origin in ground.origins(20) {
                        let normal = if random.unit() < 0.5 { ground.normal } else { -ground.normal };
                        let around = hemisphere((normal + 0.2 * random.unit() * random.direction()).normalize(), 20);
                        let off = [0.0, 1e-6, -1e-6, 1e-3][round % 4] * shift.length().max(1.0);
                        let bits = blocked(&tracer, origin + off * ground.normal, &around, &mut state);
                        bits.into_iter().for_each(|bit| seen[usize::from(bit)] += 1);
                    }
                }
                assert!(seen.iter().all(|&count| count > 100), "both answers occur: {seen:?}");
            }
        }
    }
}
