//! glTF files as text, with their data in place.
#![allow(dead_code, reason = "each test uses its part")]

/// A data URI of some bytes, percent-encoded.
pub(crate) fn data_uri(bytes: &[u8]) -> String {
    let escaped: String = bytes.iter().map(|b| format!("%{b:02x}")).collect();
    format!("data:application/octet-stream,{escaped}")
}

/// Little-endian bytes of floats.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// A glTF text of one buffer with the triangle (0,0,0) (1,0,0) (0,1,0) as accessor 0 and the texture coordinates
/// (0,0) (1,0) (0,1) as accessor 1; `rest` is the JSON of everything else, which begins with a comma.
pub(crate) fn triangle(rest: &str) -> String {
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let coordinates = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let bytes = [floats(&positions), floats(&coordinates)].concat();
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"uri":"{}","byteLength":{}}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":24}}],
        "accessors":[
          {{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
          {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}}]
        {rest} }}"#,
        data_uri(&bytes),
        bytes.len()
    )
}

/// The mesh of [`triangle`], with more members of its primitive.
pub(crate) fn mesh(more: &str) -> String {
    format!(r#","meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}{more}}}]}}]"#)
}

/// One node that shows mesh 0.
pub(crate) const SHOWN: &str = r#","nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0"#;
