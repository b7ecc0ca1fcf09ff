//! Coverage, depth and interpolation against rays through the same pixels.

mod handmade;

use glam::{DVec3, Vec3};
use handmade::{add_triangles, camera, empty, paint, white};
use probe_io::Environment;
use raytrace::{Hit, Ray, Tracer};
use render_cpu::{Frame, Image, render};

/// How far a pixel's centre must lie from all edges of a triangle, in weights, to count as inside.
const EDGE: f32 = 0.02;

/// Numbers in [0, 1) that look random: a multiplicative generator of Lehmer's kind.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1_u64 << 24) as f32
    }

    fn point(&mut self, size: f32) -> Vec3 {
        (Vec3::new(self.next(), self.next(), self.next()) - 0.5) * size
    }
}

/// Triangles of all sizes around the eye, so that many are cut by the near plane and the borders.
fn soup(count: usize, seed: u64) -> Vec<[Vec3; 3]> {
    let mut numbers = Numbers(seed);
    (0..count)
        .map(|i| {
            let centre = numbers.point(6.0);
            let size = if i % 7 == 0 { 8.0 } else { 1.0 };
            [0, 1, 2].map(|_| centre + numbers.point(size))
        })
        .collect()
}

fn frame() -> Frame {
    let mut frame = Frame::plain(camera([0.3, 0.2, 2.5], [0.1, -0.3, -1.0]), 96, 64);
    frame.sky = false;
    frame
}

/// World ray through a pixel's centre, written from the definition of the camera.
fn ray(frame: &Frame, x: u32, y: u32) -> Ray {
    let [eye, target, up] = [frame.camera.eye, frame.camera.target, frame.camera.up].map(|v| Vec3::from(v).as_dvec3());
    let forward = (target - eye).normalize();
    let right = forward.cross(up).normalize();
    let tangent = (f64::from(frame.camera.vertical_fov) / 2.0).tan();
    let half = DVec3::new(f64::from(frame.width), f64::from(frame.height), 0.0) / 2.0;
    let across = (f64::from(x) + 0.5 - half.x) / half.y * tangent;
    let along = (half.y - f64::from(y) - 0.5) / half.y * tangent;
    let direction = forward + right * across + right.cross(forward) * along;
    Ray::new(eye.as_vec3(), direction.as_vec3())
}

/// One tracer per triangle: backs are not drawn, so a ray must be able to go on behind them.
fn tracers(triangles: &[[Vec3; 3]]) -> Vec<Tracer> {
    triangles.iter().map(|corners| Tracer::build(corners, &[[0, 1, 2]], &[])).collect()
}

/// The first front that a ray meets.
fn first_front(tracers: &[Tracer], ray: &Ray) -> Option<(usize, Hit)> {
    let hits = tracers.iter().enumerate().filter_map(|(i, tracer)| {
        let hit = tracer.closest(ray, &|_, _, _| true)?;
        hit.front.then_some((i, hit))
    });
    hits.min_by(|a, b| a.1.t.total_cmp(&b.1.t))
}

/// Draws triangles so that each pixel shows the colour of its point.
fn draw(triangles: &[[Vec3; 3]], color: impl Fn(usize, Vec3) -> [f32; 4]) -> Image {
    let mut prt = empty();
    add_triangles(&mut prt, white(), triangles);
    paint(&mut prt, color);
    render(&prt, &Environment::constant([1.0; 3]), &frame()).expect("a sound scene and frame")
}

/// Number of pixels, and of those well inside a triangle, where the picture shows another triangle than the ray meets.
fn disagreements(triangles: &[[Vec3; 3]], image: &Image) -> (usize, usize) {
    let (mut all, mut inside) = (0, 0);
    let tracers = tracers(triangles);
    for (i, pixel) in image.linear.iter().enumerate() {
        let (x, y) = (i as u32 % image.width, i as u32 / image.width);
        let hit = first_front(&tracers, &ray(&frame(), x, y));
        let expected = hit.map_or(0, |(triangle, _)| triangle + 1);
        if (pixel[0] * 1024.0).round() as usize != expected {
            all += 1;
            inside += usize::from(hit.is_some_and(|(_, h)| h.u.min(h.v).min(1.0 - h.u - h.v) > EDGE));
        }
    }
    (all, inside)
}

#[test]
fn each_pixel_shows_the_triangle_that_its_ray_meets() {
    let triangles = soup(80, 7);
    let image = draw(&triangles, |vertex, _| [(vertex / 3 + 1) as f32 / 1024.0; 4]);
    let (all, inside) = disagreements(&triangles, &image);
    assert!(inside == 0 && all < image.linear.len() / 500, "{all} pixels differ, {inside} of them inside");
}

#[test]
fn a_picture_of_a_displaced_triangle_can_fail() {
    let mut triangles = soup(80, 7);
    let image = draw(&triangles, |vertex, _| [(vertex / 3 + 1) as f32 / 1024.0; 4]);
    triangles.iter_mut().flatten().for_each(|corner| *corner += Vec3::new(0.1, 0.0, 0.0));
    assert!(disagreements(&triangles, &image).1 > 20);
}

#[test]
fn colours_are_interpolated_on_the_triangle_and_not_on_the_picture() {
    let triangles = soup(40, 11);
    let place = |p: Vec3| (p * 0.05 + 0.5).to_array();
    let image = draw(&triangles, |_, p| [place(p)[0], place(p)[1], place(p)[2], 1.0]);
    let tracers = tracers(&triangles);
    let (mut compared, mut worst) = (0, 0.0_f32);
    for (i, pixel) in image.linear.iter().enumerate() {
        let ray = ray(&frame(), i as u32 % image.width, i as u32 / image.width);
        let Some((_, hit)) = first_front(&tracers, &ray) else { continue };
        if hit.u.min(hit.v).min(1.0 - hit.u - hit.v) > EDGE {
            let expected = place(ray.origin + ray.direction * hit.t);
            worst = worst.max(handmade::distance(*pixel, expected));
            compared += 1;
        }
    }
    assert!(compared > 1000, "only {compared} pixels compared");
    assert!(worst < 2e-4, "a colour is off by {worst}");
}

#[test]
fn neighbours_leave_no_gap_and_no_overlap() {
    // A fan around a point, blended at one half: a gap stays black, an overlap gets more than one half.
    let mut numbers = Numbers(3);
    let spokes: Vec<Vec3> = (0..37)
        .map(|i| {
            let angle = i as f32 / 37.0 * std::f32::consts::TAU;
            Vec3::new(angle.cos(), angle.sin(), 0.0) * (5.0 + numbers.next())
        })
        .collect();
    let hub = Vec3::new(0.137, -0.071, 0.0);
    let fan: Vec<_> = (0..37).map(|i| [hub, spokes[i], spokes[(i + 1) % 37]]).collect();
    let mut prt = empty();
    let mut half = white();
    half.base_color[3] = 0.5;
    half.alpha = coeff_io::AlphaMode::Blend;
    add_triangles(&mut prt, half, &fan);
    let image = render(&prt, &Environment::constant([1.0; 3]), &frame()).expect("a sound scene and frame");
    for (i, pixel) in image.linear.iter().enumerate() {
        assert!((pixel[0] - 0.5).abs() < 1e-3, "pixel {i} shows {}", pixel[0]);
    }
}
