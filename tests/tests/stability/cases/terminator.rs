//! Coarse bodies with smooth normals: no facet may darken what the light still reaches.

use super::Case;
use super::baking::{quiet, radiance};
use super::published::{merged, random_direction};
use bake::settings;
use coeff_io::{Refine, Settings};
use glam::Vec3;
use raytrace::{Ray, Tracer, offset_origin_on};
use sampling::rng::Rng;
use scene::{Material, Mesh, Scene};
use sh_math::{Bands, project};
use std::f32::consts::{PI, TAU};

pub(crate) fn twelve_sided_sphere() -> Case {
    Case {
        title: "12-sided sphere with smooth normals under 40 suns",
        bound: "share of receivers with n·l > 0.1 darker than 1 % of a facing one: none, as nothing stands above a convex body",
        limit: 0.0,
        ours: || dark_receivers(vec![ball()], &settings::standard()),
        naive_method: "a shadow ray from each point of a facet",
        naive: || dark_points(vec![ball()], &settings::standard()),
    }
}

pub(crate) fn split_sphere() -> Case {
    Case {
        title: "the same sphere over a ground, split to edges of 0.15, 5 bands",
        bound: "the same share: pieces see their own facet where their normal leans over it, but five bands reach past it",
        limit: 0.0,
        ours: || dark_receivers(ball_on_ground(), &split()),
        naive_method: "a shadow ray from each point of a facet",
        naive: || dark_points(ball_on_ground(), &split()),
    }
}

fn split() -> Settings {
    Settings { refine: Refine::Edge(0.15), ..settings::standard() }
}

/// Cosine from which a point counts as lit.
const LIT: f32 = 0.1;

/// The suns that stand high enough to pass any mesh but the first.
fn suns(meshes: &[Mesh]) -> Vec<Vec3> {
    let lowest = if meshes.len() > 1 { 0.2 } else { -1.0 };
    let mut rng = Rng::new(2, 0);
    (0..40).map(|_| random_direction(&mut rng)).filter(|sun| sun.y > lowest).collect()
}

fn scene_of(meshes: Vec<Mesh>) -> Scene {
    Scene { meshes, materials: vec![Material::default()], ..Scene::default() }
}

fn ball_on_ground() -> Vec<Mesh> {
    let mut ground = scene::builtin("plane").expect("builtin").meshes.remove(0);
    ground.positions.iter_mut().for_each(|p| p.y = -1.0);
    vec![ball(), ground]
}

/// A unit sphere of 12 by 6 quads with the normals of the sphere.
fn ball() -> Mesh {
    let (around, rows) = (12, 6);
    let point = |i: u32, j: u32| {
        let (turn, polar) = (TAU * i as f32 / around as f32, PI * j as f32 / rows as f32);
        let ((sin, cos), (s, c)) = (libm::sincosf(turn), libm::sincosf(polar));
        Vec3::new(s * sin, c, s * cos)
    };
    let mut mesh = Mesh { positions: vec![Vec3::Y, Vec3::NEG_Y], ..Mesh::default() };
    mesh.positions.extend((1..rows).flat_map(|j| (0..around).map(move |i| point(i, j))));
    let at = |i: u32, j: u32| match j {
        0 => 0,
        j if j == rows => 1,
        j => 2 + (j - 1) * around + i % around,
    };
    for (i, j) in (0..rows).flat_map(|j| (0..around).map(move |i| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        mesh.triangles
            .extend([[a, b, c], [a, c, d]].into_iter().filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
    }
    mesh.normals = mesh.positions.clone();
    mesh
}

/// Share of the first mesh's lit receivers that stay dark under the suns.
fn dark_receivers(meshes: Vec<Mesh>, settings: &Settings) -> f64 {
    let scene = scene_of(meshes);
    let prt = quiet(&scene, settings);
    let own = prt.meshes[0].vertices as usize;
    let (mut lit, mut dark) = (0, 0);
    for sun in suns(&scene.meshes) {
        let light = project(Bands::new(5).expect("in range"), [(sun.as_dvec3(), [std::f64::consts::PI; 3])]);
        for (value, normal) in radiance(&prt, &light).into_iter().zip(&prt.geometry.normals).take(own) {
            // what is no number is lit and dark
            let turned_away = Vec3::from(*normal).dot(sun) <= LIT;
            if !turned_away {
                lit += 1;
                let bright = value >= 0.01;
                dark += u32::from(!bright);
            }
        }
    }
    f64::from(dark) / f64::from(lit)
}

/// Points of the first mesh's facets with interpolated normals, tested by a ray to the sun.
fn dark_points(meshes: Vec<Mesh>, settings: &Settings) -> f64 {
    let scene = scene_of(meshes);
    let scene = bake::refine(&scene, settings).expect("splits");
    let (mesh, all) = (&scene.meshes[0], merged(&scene.meshes));
    let tracer = Tracer::build(&all.positions, &all.triangles, &[]);
    let (mut lit, mut dark) = (0, 0);
    for sun in suns(&scene.meshes) {
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for (u, v) in [(1.0 / 3.0, 1.0 / 3.0), (0.05, 0.05), (0.9, 0.05), (0.05, 0.9)] {
                if mesh.normal(t, u, v).dot(sun) > LIT {
                    let corners = corners.map(|i| mesh.positions[i as usize]);
                    let origin = offset_origin_on(corners, mesh.position(t, u, v), mesh.face_normal(t));
                    lit += 1;
                    dark += u32::from(tracer.occluded(&Ray::new(origin, sun), &|_, _, _| true));
                }
            }
        }
    }
    f64::from(dark) / f64::from(lit)
}
