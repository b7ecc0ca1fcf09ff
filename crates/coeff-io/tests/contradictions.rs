//! Data that contradicts itself is neither written nor read.

mod sample;

use coeff_io::{BandChoice, Error, MapLight, Maps, Node, Prt, Quality, Refine, Volume};
use sample::sample;
use sh_math::hemisphere::Basis;

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
    ("maps of a mesh too few", |p| _ = maps(p).sheet_of_mesh.pop()),
    ("a mesh on a sheet that is not there", |p| maps(p).sheet_of_mesh[0] = Some(5)),
    ("maps without coordinates", |p| p.geometry.uv1.clear()),
    ("maps of no bands", |p| maps(p).light = MapLight::Relightable { bands: 0 }),
    ("maps of bands that overflow", |p| maps(p).light = MapLight::Relightable { bands: 1 << 16 }),
    ("maps of another basis", |p| maps(p).basis = Basis::H6),
    ("a sheet without width", |p| maps(p).sheets[0].layers.width = 0),
    ("a sheet too wide", |p| maps(p).sheets[0].layers.width = 32_769),
    ("a sheet whose sizes overflow", |p| {
        let layers = &mut maps(p).sheets[0].layers;
        (layers.width, layers.height, layers.count) = (1 << 15, 1 << 15, u32::MAX);
    }),
    ("a sheet of two channels", |p| maps(p).sheets[0].layers.channels = 2),
    ("a sheet with a byte too few", |p| _ = maps(p).sheets[1].layers.bytes.pop()),
    ("a sheet without bytes", |p| maps(p).sheets[1].layers.bytes.clear()),
    ("a texel that is no number", |p| maps(p).sheets[0].layers.bytes[8..12].copy_from_slice(&f32::NAN.to_le_bytes())),
    ("eight bits without charts", |p| maps(p).sheets[1].layers.bytes.truncate(3)),
    ("eight bits of more charts than there are", |p| maps(p).sheets[1].layers.bytes[..4].fill(0xFF)),
    ("eight bits on no curve", |p| maps(p).sheets[1].layers.bytes[5] = 2),
    ("eight bits of no range", |p| maps(p).sheets[1].layers.bytes[7..11].copy_from_slice(&f32::NAN.to_le_bytes())),
    ("eight bits of a chart that is not there", |p| maps(p).sheets[1].layers.bytes[55] = 2),
    ("an infinite half", |p| maps(p).sheets[2].layers.bytes[2..4].copy_from_slice(&[0, 0x7C])),
    ("a block too few", |p| maps(p).sheets[3].layers.bytes.truncate(3 + 24 + 40)),
    ("blocks on no curve", |p| maps(p).sheets[3].layers.bytes[2] = 9),
    ("blocks of no range", |p| maps(p).sheets[4].layers.bytes[3..7].copy_from_slice(&f32::INFINITY.to_le_bytes())),
    ("blocks whose sizes overflow", |p| maps(p).sheets[4].layers.count = u32::MAX),
    ("a volume of two channels", |p| volume(p).channels = 2),
    ("a volume of bands that overflow", |p| volume(p).light = MapLight::Relightable { bands: u32::MAX }),
    ("a volume without place", |p| volume(p).origin[1] = f32::NAN),
    ("a volume without size", |p| volume(p).spacing[2] = 0.0),
    ("a volume that ends nowhere", |p| volume(p).spacing[1] = f32::MAX),
    ("a volume without cells", |p| volume(p).cells[0] = 0),
    ("a volume of more cells than it has", |p| volume(p).cells = [4, 4, 4]),
    ("a volume of cells that overflow", |p| volume(p).cells = [u32::MAX; 3]),
    ("a volume with a cell too few", |p| _ = volume(p).nodes.pop()),
    ("a cell that is its own part", |p| volume(p).nodes[0] = Node::Split(0)),
    ("a cell split within eight", |p| volume(p).nodes[0] = Node::Split(3)),
    ("parts beyond the end", |p| volume(p).nodes[0] = Node::Split(10)),
    ("parts that end beyond", |p| volume(p).nodes[0] = Node::Split(u32::MAX)),
    ("parts of two cells", |p| volume(p).nodes[1] = Node::Split(2)),
    ("parts of none", |p| volume(p).nodes[0] = Node::Leaf([0; 8])),
    ("a cycle", |p| volume(p).nodes[5] = Node::Split(2)),
    ("a probe that is not there", |p| volume(p).nodes[3] = Node::Leaf([0, 1, 2, 3, 4, 5, 6, 8])),
    ("a probe that is a mark", |p| volume(p).nodes[3] = Node::Leaf([u32::MAX, 9, 0, 0, 0, 0, 0, 1])),
    ("no probes", |p| volume(p).positions.clear()),
    ("a probe too few", |p| _ = volume(p).positions.pop()),
    ("a validity too few", |p| _ = volume(p).validity.pop()),
    ("a validity of 2", |p| volume(p).validity[0] = 2.0),
    ("a coefficient too few", |p| _ = volume(p).values.pop()),
    ("a coefficient that is no number", |p| volume(p).values[7] = f32::NAN),
    ("a probe that is nowhere", |p| volume(p).positions[1][2] = f32::INFINITY),
    ("a distance too few", |p| _ = volume(p).distances.pop()),
    ("a negative distance", |p| volume(p).distances[3] = -1.0),
    ("a reach that is no number", |p| volume(p).reach = f32::NAN),
    ("maps of which there are none", |p| volume(p).resolution = u32::MAX),
];

fn maps(prt: &mut Prt) -> &mut Maps {
    prt.maps.as_mut().unwrap()
}

fn volume(prt: &mut Prt) -> &mut Volume {
    prt.volume.as_mut().unwrap()
}

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
    let count = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let row = (0..count).map(|i| 32 + 32 * i).find(|row| &bytes[*row..*row + 4] == b"TRIS").unwrap();
    let offset = u64::from_le_bytes(bytes[row + 8..row + 16].try_into().unwrap());
    let corner = offset as usize + 12;
    bytes[corner] = 200;
    let sum = crc32fast::hash(&bytes[offset as usize..offset as usize + 36]);
    bytes[row + 24..row + 28].copy_from_slice(&sum.to_le_bytes());
    bytes[28..32].fill(0);
    let sum = crc32fast::hash(&bytes[..32 + 32 * count]);
    bytes[28..32].copy_from_slice(&sum.to_le_bytes());
    let error = Prt::from_bytes(&bytes).unwrap_err();
    assert!(matches!(error, Error::Invalid { at, .. } if at == corner as u64), "{error}");
    assert!(error.to_string().contains("vertex 200"), "{error}");
}
