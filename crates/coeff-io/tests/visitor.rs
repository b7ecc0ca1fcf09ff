//! An object in a scene takes from the volume what its place and normals call for.

mod sample;

use coeff_io::{MapLight, Node, Prt, VisitorError, Volume};
use glam::{Affine3A, Quat, Vec3};
use sample::sample;
use sh_math::{Bands, zonal};

/// A volume of one cell about the origin under an open sky in 3 bands of light: irradiance / pi answers to each coefficient of the light by
/// the factor of its band.
fn open_sky() -> Volume {
    let mut probe = vec![0.0; 9 * 9];
    for k in 0..9usize {
        probe[k * 9 + k] = zonal::clamped_cosine(k.isqrt()) as f32;
    }
    Volume {
        origin: [-8.0; 3],
        spacing: [16.0; 3],
        cells: [1; 3],
        nodes: vec![Node::Leaf([0, 1, 2, 3, 4, 5, 6, 7])],
        light: MapLight::Relightable { bands: 3 },
        channels: 1,
        values: probe.repeat(8),
        positions: vec![[0.0; 3]; 8],
        validity: vec![1.0; 8],
        distances: Vec::new(),
        resolution: 0,
        reach: 1.0,
    }
}

/// The sample with 3 bands and such a volume.
fn scene() -> Prt {
    let mut prt = sample();
    let rows = prt.geometry.positions.len() * 9 * prt.transfer.channels as usize;
    (prt.transfer.bands, prt.settings.bands, prt.plan.bands) = (3, 3, 3);
    prt.transfer.values = vec![0.25; rows];
    prt.volume = Some(open_sky());
    // Those of the sample are of two bands.
    prt.transfer_textures = None;
    prt.codebooks.diffuse = None;
    prt
}

/// Largest difference between the transfer of the object's vertices and the closed form about their normals, each turned by `turn`.
fn worst(all: &Prt, first: usize, object: &Prt, turn: Quat) -> f32 {
    let channels = all.transfer.channels as usize;
    let mut worst = 0.0f32;
    for (vertex, normal) in object.geometry.normals.iter().enumerate() {
        let mut expected = [0.0; 9];
        zonal::cosine_transfer(Bands::new(3).unwrap(), turn * Vec3::from(*normal), &mut expected);
        let row = &all.transfer.values[(first + vertex) * 9 * channels..][..9 * channels];
        for (out, expected) in row.chunks_exact(channels).zip(expected) {
            worst = out.iter().fold(worst, |worst, value| worst.max((value - expected).abs()));
        }
    }
    worst
}

#[test]
fn vertices_take_the_light_of_their_turned_normals() {
    let (scene, object) = (scene(), sample());
    let turn = Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-0.4);
    let place = Affine3A::from_scale_rotation_translation(Vec3::splat(0.5), turn, Vec3::new(1.0, -2.0, 0.5));
    let all = scene.with_visitor(&object, &place).unwrap();
    let first = scene.geometry.positions.len();
    assert!(worst(&all, first, &object, turn) < 1e-5, "{}", worst(&all, first, &object, turn));
    assert!(worst(&all, first, &object, Quat::IDENTITY) > 0.05, "normals that were not turned must show");
    assert_eq!(all.transfer.values[..scene.transfer.values.len()], scene.transfer.values, "the scene stays");
    let moved = Vec3::from(all.geometry.positions[first]);
    assert!(moved.distance(place.transform_point3(Vec3::from(object.geometry.positions[0]))) < 1e-6);
}

/// What is put together is a file like any other: it can be written and read.
#[test]
fn the_whole_is_sound() {
    let all = scene().with_visitor(&sample(), &Affine3A::IDENTITY).unwrap();
    assert_eq!(Prt::from_bytes(&all.to_bytes().unwrap()).unwrap(), all);
    assert_eq!(all.meshes.len(), 2 * sample().meshes.len());
    assert_eq!(all.materials.len(), 2 * sample().materials.len());
}

#[test]
fn a_scene_without_a_fitting_volume_refuses() {
    let refused = |change: fn(&mut Prt)| {
        let mut prt = scene();
        change(&mut prt);
        prt.with_visitor(&sample(), &Affine3A::IDENTITY).unwrap_err()
    };
    assert_eq!(refused(|prt| prt.volume = None), VisitorError::NoVolume);
    let fixed = refused(|prt| {
        let light = MapLight::Fixed { probe: "noon.hdr".into(), bands: 3 };
        prt.volume = prt.volume.take().map(|volume| Volume { light, ..volume });
    });
    assert!(fixed.to_string().contains("noon.hdr"), "{fixed}");
    let other = refused(|prt| prt.transfer.bands = 4);
    assert!(matches!(other, VisitorError::Unlike(_)), "{other}");
}
