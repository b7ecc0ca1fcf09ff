//! The Cornell box with a normal map on its blocks, baked once for all tests.

use bake::{Directional, FixedLight, SheetSettings};
use coeff_io::{Bounces, Quality, Refine, Settings};
use glam::{Affine2, Vec3};
use scene::lightmap::{Density, Unwrap, unwrap};
use scene::{Scene, Texture, TextureSlot, Wrap};
use std::ops::ControlFlow;
use std::sync::OnceLock;
use study::bases::scene::{Goal, Request};

/// A scene and what arrives at its texels.
pub(crate) struct Baked {
    pub(crate) scene: Scene,
    /// One with normal maps, one without.
    pub(crate) sheets: Vec<SheetSettings>,
    pub(crate) found: Directional,
}

/// Made once.
pub(crate) fn baked() -> &'static Baked {
    static BAKED: OnceLock<Baked> = OnceLock::new();
    BAKED.get_or_init(|| {
        let mut scene = scene::builtin("cornell-box").unwrap();
        let bent: Vec<usize> = (0..scene.meshes.len()).skip(1).step_by(2).collect();
        let plain: Vec<usize> = (0..scene.meshes.len()).step_by(2).collect();
        bump(&mut scene, &bent);
        let sheets = [(bent, true), (plain, false)].map(|(meshes, directional)| {
            let asked = Unwrap { density: Density::Side(24), padding: 1 };
            let atlas = unwrap(&mut scene, &meshes, &asked, &|_, _, _| {}).unwrap();
            SheetSettings { meshes, width: atlas.width, height: atlas.height, directional }
        });
        let settings = Settings {
            bands: 4,
            quality: Quality::Rays(64),
            bounces: Bounces::Fixed(1),
            refine: Refine::Off,
            ..bake::settings::standard()
        };
        let coefficients =
            (0..16).map(|i| [0, 1, 2].map(|c| if i == 0 { 3.0 } else { ((7 * i + 5 * c) % 11) as f32 / 11.0 - 0.5 }));
        let light = FixedLight { name: "test".into(), coefficients: coefficients.collect() };
        let found = bake::directional(&scene, &settings, &sheets, &light, &|_| ControlFlow::Continue(())).unwrap();
        Baked { scene, sheets: sheets.to_vec(), found }
    })
}

/// Gives meshes tangents and a material of their own with a normal map of slopes up to 45 degrees.
fn bump(scene: &mut Scene, meshes: &[usize]) {
    let byte = |v: f32| (127.5 + 127.5 * v).round() as u8;
    let texel = |i: u32| {
        let (x, y) = ((i % 16) as f32 / 15.0 - 0.5, (i / 16) as f32 / 15.0 - 0.5);
        let n = Vec3::new(1.4 * x, 1.4 * y, 1.0).normalize();
        [byte(n.x), byte(n.y), byte(n.z), 255]
    };
    let texture = scene.textures.len() as u32;
    let rgba = (0..256).map(texel).collect();
    scene.textures.push(Texture { name: "bumps".into(), width: 16, height: 16, rgba, wrap: [Wrap::Repeat; 2] });
    for &index in meshes {
        let mut material = scene.material(index).clone();
        material.normal_texture = Some(TextureSlot { texture, uv_set: 0, transform: Affine2::IDENTITY });
        let mesh = &mut scene.meshes[index];
        mesh.tangents = mesh.normals.iter().map(|normal| normal.any_orthonormal_vector().extend(1.0)).collect();
        mesh.material = scene.materials.len() as u32;
        scene.materials.push(material);
    }
}

/// Everything that was baked, with times that fall with the number of functions.
pub(crate) fn request(of: &Baked, goal: Goal) -> Request<'_> {
    static TIMES: OnceLock<Vec<f64>> = OnceLock::new();
    let nanoseconds = TIMES.get_or_init(|| sh_math::hemisphere::Basis::ALL.map(|basis| basis.count() as f64).to_vec());
    Request {
        scene: &of.scene,
        light: "test",
        sheet_options: "--texels 24",
        sheets: &of.sheets,
        found: &of.found,
        goal,
        nanoseconds,
    }
}
