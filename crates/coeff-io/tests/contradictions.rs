//! Data that contradicts itself is neither written nor read.

mod sample;

use coeff_io::{BandChoice, Error, Prt, Quality, Refine};
use sample::sample;

/// A name and a change that breaks one rule of `docs/format.md`.
type Break = (&'static str, fn(&mut Prt));

const BREAKS: &[Break] = &[
    ("an index beyond the vertices", |p| p.geometry.triangles[1][2] = 7),
    ("an index of another mesh", |p| p.geometry.triangles[1][2] = 4),
    ("a missing normal", |p| p.geometry.normals.truncate(6)),
    ("a long normal", |p| p.geometry.normals[3] = [0.0, 1.1, 0.0]),
    ("a normal that is no number", |p| p.geometry.normals[3] = [f32::NAN; 3]),
    ("an infinite position", |p| p.geometry.positions[3][1] = f32::INFINITY),
    ("a tangent without hand", |p| p.geometry.tangents[0][3] = 0.0),
    ("a missing tangent", |p| p.geometry.tangents.truncate(3)),
    ("an infinite texture coordinate", |p| p.geometry.uv1[0][0] = f32::NEG_INFINITY),
    ("a negative colour", |p| p.geometry.colors[0][0] = -1.0),
    ("no triangle", |p| p.geometry.triangles.clear()),
    ("a missing transfer value", |p| p.transfer.values.truncate(83)),
    ("a transfer value that is no number", |p| p.transfer.values[83] = f32::NAN),
    ("an albedo above 1", |p| p.transfer.albedo[0][0] = 1.5),
    ("a missing albedo", |p| p.transfer.albedo.clear()),
    ("a negative openness", |p| p.transfer.openness[1] = -0.5),
    ("two channels", |p| p.transfer.channels = 2),
    ("no band", |p| p.transfer.bands = 0),
    ("four thousand million bands", |p| p.transfer.bands = u32::MAX),
    ("a mesh with a gap before it", |p| p.meshes[1].first_vertex = 5),
    ("a mesh that overlaps", |p| p.meshes[1].first_triangle = 1),
    ("a mesh beyond the triangles", |p| p.meshes[1].triangles = u32::MAX),
    ("vertices of no mesh", |p| p.meshes.truncate(1)),
    ("a material that is not there", |p| p.meshes[0].material = 2),
    ("a texture that is not there", |p| p.materials[0].normal_texture.as_mut().unwrap().texture = 2),
    ("a third set of texture coordinates", |p| p.materials[0].normal_texture.as_mut().unwrap().uv_set = 2),
    ("a texture matrix that is no number", |p| {
        p.materials[0].emissive_texture.as_mut().unwrap().transform[0][0] = f32::NAN
    }),
    ("a metal of 2", |p| p.materials[1].metallic = 2.0),
    ("an emission that is no number", |p| p.materials[1].emissive[2] = f32::NAN),
    ("a texture with a row too few", |p| p.textures[1].height = 1),
    ("a texture without pixels", |p| p.textures[1].rgba.clear()),
    ("a texture whose sides overflow", |p| (p.textures[1].width, p.textures[1].height) = (1 << 31, 1 << 31)),
    ("no camera", |p| p.cameras.clear()),
    ("a camera that looks at itself", |p| p.cameras[0].target = p.cameras[0].eye),
    ("a camera without angle", |p| p.cameras[0].vertical_fov = 0.0),
    ("a camera of half a turn", |p| p.cameras[0].vertical_fov = std::f32::consts::PI),
    ("a plan of one channel", |p| p.plan.channels = 1),
    ("a plan that decides twice", |p| p.plan.rows[1].effect = p.plan.rows[0].effect),
    ("a plan of three bands", |p| p.plan.bands = 3),
    ("a plan with a mesh that is not there", |p| p.plan.meshes[0].mesh = 2),
    ("a mesh with more shadowed receivers than receivers", |p| p.plan.meshes[0].shadowed = 4),
    ("more dark receivers than shadowed ones", |p| p.plan.dark_receivers = 4),
    ("a stake that is no number", |p| p.plan.rows[0].stake = f32::NAN),
    ("a negative norm of a band", |p| p.plan.survey.band_norms[1] = -1.0),
    ("settings of fewer bands", |p| p.settings.bands = 1),
    ("settings of exactly other bands", |p| p.settings.band_choice = BandChoice::Exactly),
    ("a light that is no number", |p| p.settings.light[0] = f32::NAN),
    ("a time that is no number", |p| p.settings.time = Some(f32::NAN)),
    ("an edge of no length", |p| p.settings.refine = Refine::Edge(0.0)),
    ("a worst receiver that is not there", |p| p.achieved.worst_receiver = 7),
    ("an error that is no number", |p| p.achieved.error[1] = f32::NAN),
    ("an error to reach that is no number", |p| p.settings.quality = Quality::Error(f32::NAN)),
];

#[test]
fn contradictions_are_not_written() {
    for (what, spoil) in BREAKS {
        let mut prt = sample();
        spoil(&mut prt);
        assert!(matches!(prt.to_bytes(), Err(Error::Invalid { .. })), "{what} was written");
    }
}

#[test]
fn contradictions_are_not_written_can_fail() {
    assert!(sample().to_bytes().is_ok());
}

/// The same rules on the way in, with the place: a vertex index is made too large and the checksums right again.
#[test]
fn contradictions_are_not_read() {
    let mut bytes = sample().to_bytes().unwrap();
    let row = (0..13).map(|i| 32 + 32 * i).find(|row| &bytes[*row..*row + 4] == b"TRIS").unwrap();
    let offset = u64::from_le_bytes(bytes[row + 8..row + 16].try_into().unwrap());
    let corner = offset as usize + 12;
    bytes[corner] = 200;
    let sum = crc32fast::hash(&bytes[offset as usize..offset as usize + 36]);
    bytes[row + 24..row + 28].copy_from_slice(&sum.to_le_bytes());
    bytes[28..32].fill(0);
    let sum = crc32fast::hash(&bytes[..32 + 32 * 13]);
    bytes[28..32].copy_from_slice(&sum.to_le_bytes());
    let error = Prt::from_bytes(&bytes).unwrap_err();
    assert!(matches!(error, Error::Invalid { at, .. } if at == corner as u64), "{error}");
    assert!(error.to_string().contains("vertex 200"), "{error}");
}
