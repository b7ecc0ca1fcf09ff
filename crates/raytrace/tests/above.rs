//! Whether anything stands above a tangent plane: the answer of a loop over all triangles, in a number of steps that hardly grows.
//!
//! Steps are counted, not timed. The inputs are those that make boxes useless: much of the scene lies in the plane that is asked about.

mod shapes;

use glam::{Mat3, Quat, Vec3, vec3};
use raytrace::{Ray, Tracer};
use shapes::Random;

/// Triangles with one normal per corner, as a scene has them.
#[derive(Default)]
struct Shape {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Points and normals that are asked about.
    asked: Vec<(Vec3, Vec3)>,
}

impl Shape {
    fn quad(&mut self, [a, b, c, d]: [Vec3; 4]) {
        let first = self.positions.len() as u32;
        self.positions.extend([a, b, c, d]);
        self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        let normal = (b - a).cross(c - a).normalize();
        self.asked.extend([a, b, c, d].map(|p| (p, normal)));
    }

    /// A floor of side x side squares in y = 0, its corners at random places of a grid so that no two triangles are alike.
    fn floor(side: u32) -> Shape {
        let mut shape = Shape::default();
        let mut random = Random::new(7);
        let n = side + 1;
        let place = |i: u32, random: &mut Random| (i as f32 + 0.3 * random.unit()) / side as f32 * 20.0 - 10.0;
        for k in 0..n * n {
            let (x, z) = (place(k % n, &mut random), place(k / n, &mut random));
            shape.positions.push(vec3(x, 0.0, z));
            shape.asked.push((vec3(x, 0.0, z), Vec3::Y));
        }
        let cells = (0..side * side).map(|k| k % side + k / side * n);
        shape.triangles = cells.flat_map(|i| [[i, i + n, i + 1], [i + 1, i + n, i + n + 1]]).collect();
        shape
    }

    /// Blocks of many sizes that stand on a floor, their bottoms in its plane.
    fn blocks(side: u32) -> Shape {
        let mut shape = Shape::default();
        let mut random = Random::new(3);
        shape.quad([vec3(-20.0, 0.0, -20.0), vec3(-20.0, 0.0, 20.0), vec3(20.0, 0.0, 20.0), vec3(20.0, 0.0, -20.0)]);
        for k in 0..side * side {
            let at = vec3((k % side) as f32, 0.0, (k / side) as f32) / side as f32 * 38.0 - vec3(19.0, 0.0, 19.0);
            let size = (0.2 + 0.7 * vec3(random.unit(), 3.0 * random.unit(), random.unit())) * 38.0 / side as f32;
            let corner = |i: u32| at + size * vec3((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32);
            for face in [[0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [0, 2, 3, 1], [4, 5, 7, 6]] {
                shape.quad(face.map(corner));
            }
        }
        shape
    }

    /// A ball of `rings` rings.
    fn ball(rings: u32) -> Shape {
        let mut shape = Shape::default();
        let n = 2 * rings;
        for k in 0..(rings + 1) * n {
            let (theta, phi) = ((k / n) as f32 / rings as f32, (k % n) as f32 / n as f32);
            let (theta, phi) = (theta * std::f32::consts::PI, phi * std::f32::consts::TAU);
            let p = vec3(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            shape.positions.push(p);
            shape.asked.push((p, p.normalize()));
        }
        for k in 0..rings * n {
            let (i, j) = (k, k / n * n + (k + 1) % n);
            shape.triangles.extend([[i, j, i + n], [j, j + n, i + n]]);
        }
        shape
    }

    /// The same, turned and moved; normals as the turn rounds them.
    fn placed(mut self, turn: Mat3, shift: Vec3) -> Shape {
        self.positions.iter_mut().for_each(|p| *p = turn * *p + shift);
        self.asked.iter_mut().for_each(|(p, n)| (*p, *n) = (turn * *p + shift, (turn * *n).normalize()));
        self
    }

    /// Every triangle `count` times.
    fn repeated(mut self, count: usize) -> Shape {
        self.triangles = self.triangles.repeat(count);
        self
    }

    fn tracer(&self) -> Tracer {
        Tracer::build(&self.positions, &self.triangles, &[])
    }

    /// Mean steps of the dearer of both questions over points and their backs, once the tree has learned from questions how flat it is.
    fn steps(&self) -> f64 {
        let tracer = self.tracer();
        self.mean(&tracer);
        self.mean(&tracer)
    }

    fn mean(&self, tracer: &Tracer) -> f64 {
        let (mut sum, mut count) = (0, 0);
        let every = (self.asked.len() / 2_000).max(1);
        for &(p, n) in self.asked.iter().step_by(every) {
            for n in [n, -n] {
                sum += tracer.steps_above(p, n).max(tracer.steps_faced(p, n, 1e-5));
                count += 1;
            }
        }
        sum as f64 / f64::from(count)
    }
}

fn tilt() -> Mat3 {
    Mat3::from_quat(Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.3, -0.5))
}

/// A kind of scene by its size; four times the size has sixteen times the triangles.
type Kind = (&'static str, fn(u32) -> Shape);

fn kinds() -> Vec<Kind> {
    vec![
        ("floor", Shape::floor),
        ("tilted floor", |n| Shape::floor(n).placed(tilt(), Vec3::ZERO)),
        ("tilted floor far away", |n| Shape::floor(n).placed(tilt(), vec3(300.0, 20.0, -800.0))),
        ("blocks", |n| Shape::blocks(n / 4)),
        ("tilted blocks", |n| Shape::blocks(n / 4).placed(tilt(), vec3(1.0, 2.0, 3.0))),
        ("ball", |n| Shape::ball(n / 2)),
        ("ball far away", |n| Shape::ball(n / 2).placed(tilt(), vec3(50.0, 0.0, 10.0))),
        ("all twice", |n| Shape::floor(n).placed(tilt(), Vec3::ONE).repeated(2)),
        ("one triangle many times", |n| Shape::floor(1).repeated((n * n) as usize)),
    ]
}

#[test]
fn steps_hardly_grow_with_the_scene() {
    for (name, shape) in kinds() {
        let (few, many) = (shape(24).steps(), shape(96).steps());
        assert!(many < 3.0 * few + 30.0 && many < 120.0, "{name}: {few} steps, then {many}");
    }
}

/// What the check above measures: with one box per triangle about tilted ground nearly all of them reach above it.
#[test]
fn steps_hardly_grow_with_the_scene_can_fail() {
    for side in [24, 96] {
        let shape = Shape::floor(side).placed(tilt(), Vec3::ZERO);
        let (p, n) = shape.asked[shape.asked.len() / 2];
        let reaching = shape.triangles.iter().filter(|t| {
            let corners = t.map(|i| shape.positions[i as usize]);
            let upper = corners.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
            let lower = corners.iter().copied().fold(Vec3::INFINITY, Vec3::min);
            (Vec3::select(n.cmpgt(Vec3::ZERO), upper, lower) - p).dot(n) > 1e-5
        });
        let share = reaching.count() as f64 / shape.triangles.len() as f64;
        assert!(share > 0.9, "{share} of the boxes are opened");
    }
}

/// Geometry that lies twice or a thousand times in one place is in the tree once; with a mask each may be there where others are not.
#[test]
fn triangles_in_one_place_are_kept_once() {
    let once = Shape::floor(8);
    let (n, single) = (once.triangles.len(), once.tracer());
    let many = once.repeated(1_000);
    let tracer = many.tracer();
    tracer.validate().expect("a sound tree");
    assert_eq!(tracer.memory(), single.memory());
    let masks = |masked: fn(usize, usize) -> bool| -> Vec<bool> { (0..3 * n).map(|k| masked(k / n, k % n)).collect() };
    let thrice = &many.triangles[..3 * n];
    // Copies that are masked alone, that stand before one without a mask, and that come after it.
    let kept = |masked: fn(usize, usize) -> bool| Tracer::build(&many.positions, thrice, &masks(masked)).memory();
    assert!(kept(|_, _| true) > 2 * single.memory(), "each of three masks is asked");
    assert!(kept(|copy, _| copy < 2) > 2 * single.memory(), "the first two may be met");
    assert_eq!(kept(|copy, _| copy > 0), single.memory(), "the first is met");
    let down = Ray::new(vec3(0.1, 1.0, 0.2), Vec3::NEG_Y);
    let tracer = Tracer::build(&many.positions, thrice, &masks(|copy, _| copy < 2));
    let first =
        |solid: &dyn Fn(u32, f32, f32) -> bool| tracer.closest(&down, solid).map(|hit| hit.triangle as usize / n);
    assert_eq!(first(&|_, _, _| true), Some(0));
    assert_eq!(first(&|t, _, _| t as usize >= n), Some(1));
    assert_eq!(first(&|_, _, _| false), Some(2), "no mask is asked there");
}

/// A loop over all triangles, by the words of the documentation.
fn looped(shape: &Shape, origin: Vec3, normal: Vec3, slack: Option<f32>) -> bool {
    let (o, n) = (origin.as_dvec3(), normal.as_dvec3());
    shape.triangles.iter().any(|t| {
        let corners = t.map(|i| shape.positions[i as usize]);
        let [a, b, c] = corners;
        let faced = (b - a).as_dvec3().cross((c - a).as_dvec3()).dot(n) < 0.0;
        corners.iter().any(|p| {
            let height = (p.as_dvec3() - o).dot(n);
            let tolerance = f64::from(p.abs().max(origin.abs()).max_element()) / 4_194_304.0;
            match slack {
                None => height > tolerance,
                Some(slack) => faced && height > -(f64::from(slack) + tolerance),
            }
        })
    })
}

#[test]
fn answers_are_those_of_a_loop() {
    let mut random = Random::new(19);
    let mut answers = [0; 2];
    for (name, shape) in kinds() {
        let shape = shape(24);
        let (tracer, learned) = (shape.tracer(), shape.tracer());
        (0..4).for_each(|_| assert!(shape.mean(&learned) > 0.0));
        for &(p, n) in shape.asked.iter().step_by(7) {
            // The normals of the surface, off it by rounding, and off it by a little more.
            let turned = (n + 3e-7 * random.point()).normalize();
            for (p, n) in [(p, n), (p, -n), (p, turned), (p + 1e-6 * n, -n), (p + 2e-6 * random.point(), turned)] {
                let above = looped(&shape, p, n, None);
                for tracer in [&tracer, &learned] {
                    assert_eq!(tracer.anything_above(p, n), above, "{name} at {p}, {n}");
                }
                answers[usize::from(above)] += 1;
                for slack in [1e-7, 1e-5, 1e-2] {
                    let expected = looped(&shape, p, n, Some(slack));
                    for tracer in [&tracer, &learned] {
                        assert_eq!(tracer.anything_faced(p, n, slack), expected, "{name} at {p}, {n}, {slack}");
                    }
                }
            }
        }
    }
    assert!(answers.iter().all(|&count| count > 500), "both answers occur: {answers:?}");
}
