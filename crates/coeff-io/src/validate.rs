//! Whether the parts of a [`Prt`] agree: no reader has to check an index, a length or a number again.

use crate::table::{Chunk, Kind};
use crate::{AlphaMode, BandChoice, Camera, Error, Maps, Material, Prt, Texture, TextureSlot, Volume};

/// Rounding that unit vectors and shares of 1 are allowed.
const ROUNDING: f32 = 1e-3;

/// Most columns or rows of a texture or a sheet, and most cells of a volume along an axis.
pub(crate) const LARGEST_SIDE: u32 = 32_768;

/// Checks everything; `chunks` tell where in the file a flaw lies.
///
/// # Errors
/// `Invalid` with the place and the first contradiction found.
pub(crate) fn validate(prt: &Prt, chunks: &[Chunk]) -> Result<(), Error> {
    let check = Check { chunks };
    check.arrays(prt)?;
    check.numbers(prt)?;
    check.meshes(prt)?;
    for material in &prt.materials {
        check.material(material, prt.textures.len())?;
    }
    for (i, texture) in prt.textures.iter().enumerate() {
        check.texture(i, texture)?;
    }
    if let Some(maps) = &prt.maps {
        check.maps(maps, prt)?;
    }
    if let Some(volume) = &prt.volume {
        check.volume(volume)?;
    }
    check.surfaces(prt)?;
    check.header(!prt.cameras.is_empty(), || "there is no camera".into())?;
    for camera in &prt.cameras {
        check.camera(camera)?;
    }
    check.records(prt)
}

/// Checks maps that belong to no file: all but the meshes that lie on them.
///
/// # Errors
/// As [`validate`], without a place.
pub(crate) fn maps_alone(maps: &Maps) -> Result<(), Error> {
    Check { chunks: &[] }.sheets(maps)
}

/// Checks a volume that belongs to no file.
///
/// # Errors
/// As [`validate`], without a place.
pub(crate) fn volume_alone(volume: &Volume) -> Result<(), Error> {
    Check { chunks: &[] }.volume(volume)
}

/// Knows where each kind of chunk lies.
pub(crate) struct Check<'a> {
    pub(crate) chunks: &'a [Chunk],
}

impl Check<'_> {
    pub(crate) fn require(
        &self,
        sound: bool,
        kind: Kind,
        byte: usize,
        what: impl FnOnce() -> String,
    ) -> Result<(), Error> {
        if sound {
            return Ok(());
        }
        let chunk = self.chunks.iter().find(|chunk| chunk.kind == kind).or(self.chunks.first());
        Err(Error::invalid(chunk.map_or(0, |c| c.offset) + byte as u64, what()))
    }

    /// The error of a chunk of a kind that repeats.
    pub(crate) fn require_part(&self, kind: Kind, index: usize, byte: usize, what: String) -> Result<(), Error> {
        let chunk = self.chunks.iter().find(|chunk| chunk.kind == kind && chunk.index as usize == index);
        Err(Error::invalid(chunk.map_or(0, |c| c.offset) + byte as u64, what))
    }

    pub(crate) fn header(&self, sound: bool, what: impl FnOnce() -> String) -> Result<(), Error> {
        self.require(sound, Kind::Header, 0, what)
    }

    /// Lengths of the arrays against the number of vertices.
    fn arrays(&self, prt: &Prt) -> Result<(), Error> {
        let (geometry, transfer) = (&prt.geometry, &prt.transfer);
        let vertices = geometry.positions.len();
        let fits = vertices > 0 && u32::try_from(vertices).is_ok() && !geometry.triangles.is_empty();
        self.require(fits && u32::try_from(geometry.triangles.len()).is_ok(), Kind::Positions, 0, || {
            format!(
                "{vertices} vertices and {} triangles: there must be some, and no more than 2^32",
                geometry.triangles.len()
            )
        })?;
        let lengths = [
            (Kind::Normals, geometry.normals.len(), false),
            (Kind::Tangents, geometry.tangents.len(), true),
            (Kind::Uv0, geometry.uv0.len(), true),
            (Kind::Uv1, geometry.uv1.len(), true),
            (Kind::Colors, geometry.colors.len(), true),
            (Kind::Albedo, transfer.albedo.len(), false),
            (Kind::Openness, transfer.openness.len(), true),
        ];
        for (kind, length, optional) in lengths {
            self.require(length == vertices || (optional && length == 0), kind, 0, || {
                format!("chunk {kind} has {length} elements for {vertices} vertices")
            })?;
        }
        self.header(sh_math::Bands::new(transfer.bands).is_some(), || {
            format!("{} bands are not supported", transfer.bands)
        })?;
        self.header(matches!(transfer.channels, 1 | 3), || {
            format!("{} channels: there must be 1 or 3", transfer.channels)
        })?;
        let coefficients = u64::from(transfer.bands).pow(2) * u64::from(transfer.channels);
        let expected = (vertices as u64).checked_mul(coefficients);
        self.require(expected == Some(transfer.values.len() as u64), Kind::Transfer, 0, || {
            format!("{} transfer values for {vertices} vertices with {coefficients} each", transfer.values.len())
        })
    }

    /// Every number of the arrays.
    fn numbers(&self, prt: &Prt) -> Result<(), Error> {
        let (geometry, transfer) = (&prt.geometry, &prt.transfer);
        let finite = |v: &f32| v.is_finite();
        let share = |v: &f32| (-ROUNDING..=1.0 + ROUNDING).contains(v);
        self.each(Kind::Positions, geometry.positions.as_flattened(), finite, "no finite position")?;
        self.each(Kind::Normals, &geometry.normals, |n| is_unit(n), "no unit normal")?;
        self.each(
            Kind::Tangents,
            &geometry.tangents,
            |t| is_unit(&t[..3]) && t[3].abs() == 1.0,
            "no unit tangent with handedness 1 or -1",
        )?;
        self.each(Kind::Uv0, geometry.uv0.as_flattened(), finite, "no finite texture coordinate")?;
        self.each(Kind::Uv1, geometry.uv1.as_flattened(), finite, "no finite texture coordinate")?;
        self.each(Kind::Colors, geometry.colors.as_flattened(), |c| c.is_finite() && *c >= 0.0, "no colour")?;
        self.each(Kind::Transfer, &transfer.values, finite, "no finite transfer value")?;
        self.each(Kind::Albedo, transfer.albedo.as_flattened(), share, "no albedo between 0 and 1")?;
        self.each(Kind::Openness, &transfer.openness, share, "no openness between 0 and 1")
    }

    pub(crate) fn each<T: std::fmt::Debug>(
        &self,
        kind: Kind,
        values: &[T],
        sound: impl Fn(&T) -> bool,
        what: &str,
    ) -> Result<(), Error> {
        match values.iter().position(|value| !sound(value)) {
            Some(i) => self.require(false, kind, i * size_of::<T>(), || format!("{kind}: {:?} is {what}", values[i])),
            None => Ok(()),
        }
    }

    /// Meshes divide vertices and triangles among them, and no triangle leaves its mesh.
    fn meshes(&self, prt: &Prt) -> Result<(), Error> {
        let (mut vertex, mut triangle) = (0_u64, 0_u64);
        for mesh in &prt.meshes {
            let name = &mesh.name;
            let follows = u64::from(mesh.first_vertex) == vertex && u64::from(mesh.first_triangle) == triangle;
            self.header(follows, || format!("mesh '{name}' does not begin where the mesh before it ends"))?;
            self.header((mesh.material as usize) < prt.materials.len(), || {
                format!("mesh '{name}' has material {}, which does not exist", mesh.material)
            })?;
            (vertex, triangle) = (vertex + u64::from(mesh.vertices), triangle + u64::from(mesh.triangles));
            let inside =
                vertex <= prt.geometry.positions.len() as u64 && triangle <= prt.geometry.triangles.len() as u64;
            self.header(inside, || format!("mesh '{name}' has more vertices or triangles than the file"))?;
            self.indices(prt, mesh.first_triangle as usize..triangle as usize, u64::from(mesh.first_vertex)..vertex)?;
        }
        let all = vertex == prt.geometry.positions.len() as u64 && triangle == prt.geometry.triangles.len() as u64;
        self.header(all, || "there are vertices or triangles that belong to no mesh".into())
    }

    fn indices(
        &self,
        prt: &Prt,
        triangles: std::ops::Range<usize>,
        vertices: std::ops::Range<u64>,
    ) -> Result<(), Error> {
        let first = triangles.start;
        let corners = prt.geometry.triangles[triangles].as_flattened();
        match corners.iter().position(|corner| !vertices.contains(&u64::from(*corner))) {
            Some(i) => self.require(false, Kind::Triangles, first * 12 + i * 4, || {
                format!("triangle {} has vertex {}, which is not of its mesh", first + i / 3, corners[i])
            }),
            None => Ok(()),
        }
    }

    fn material(&self, material: &Material, textures: usize) -> Result<(), Error> {
        let name = &material.name;
        let slots = [
            &material.base_color_texture,
            &material.metallic_roughness_texture,
            &material.normal_texture,
            &material.emissive_texture,
        ];
        let fits = |slot: &TextureSlot| {
            (slot.texture as usize) < textures
                && slot.uv_set <= 1
                && slot.transform.as_flattened().iter().all(|v| v.is_finite())
        };
        self.header(slots.into_iter().flatten().all(fits), || {
            format!("material '{name}' has a texture that does not exist or cannot be placed")
        })?;
        let cutoff = if let AlphaMode::Mask(cutoff) = material.alpha { cutoff } else { 0.0 };
        let shares = [material.metallic, material.roughness, material.transmission];
        let sound = shares.iter().all(|v| (0.0..=1.0).contains(v))
            && material.base_color.iter().chain(&material.emissive).all(|v| v.is_finite() && *v >= 0.0)
            && cutoff.is_finite()
            && material.normal_scale.is_finite();
        self.header(sound, || format!("material '{name}' has a factor out of range"))
    }

    fn texture(&self, index: usize, texture: &Texture) -> Result<(), Error> {
        let Texture { name, width, height, rgba, .. } = texture;
        let sides = 1..=LARGEST_SIDE;
        let fits = sides.contains(width)
            && sides.contains(height)
            && u64::from(*width) * u64::from(*height) == rgba.len() as u64;
        self.header(fits, || format!("texture {index} '{name}' of {width}x{height} has {} pixels", rgba.len()))
    }

    fn camera(&self, camera: &Camera) -> Result<(), Error> {
        let numbers = camera.eye.iter().chain(&camera.target).chain(&camera.up);
        let angle = camera.vertical_fov > 0.0 && camera.vertical_fov < std::f32::consts::PI;
        self.header(numbers.into_iter().all(|v| v.is_finite()) && angle && camera.eye != camera.target, || {
            format!("camera '{}' has no direction or no angle of view", camera.name)
        })
    }

    /// Settings, plan and achieved error against the arrays.
    fn records(&self, prt: &Prt) -> Result<(), Error> {
        let (plan, achieved) = (&prt.plan, &prt.achieved);
        self.settings(prt)?;
        let again = |i: usize| plan.rows[..i].iter().any(|row| row.effect == plan.rows[i].effect);
        self.header(!(0..plan.rows.len()).any(again), || "the plan decides twice on one effect".into())?;
        self.plan(prt)?;
        let vertices = prt.geometry.positions.len() as u64;
        self.header(u64::from(achieved.worst_receiver) < vertices, || {
            format!("the worst receiver {} does not exist", achieved.worst_receiver)
        })?;
        let of_maps = achieved.maps.iter().flat_map(|maps| &maps.error);
        let of_gloss = achieved.gloss.iter().flat_map(|gloss| gloss.error.iter().chain(&gloss.compression));
        let sound = achieved.error.iter().chain(&achieved.bounce_changes).chain(of_maps).chain(of_gloss).all(is_amount);
        self.header(sound, || "an achieved error is no number".into())
    }

    fn settings(&self, prt: &Prt) -> Result<(), Error> {
        let (settings, transfer) = (&prt.settings, &prt.transfer);
        let fits = match settings.band_choice {
            BandChoice::Exactly => settings.bands == transfer.bands,
            BandChoice::Needed => settings.bands >= transfer.bands,
        };
        self.header(fits, || format!("the settings have {} bands, the transfer {}", settings.bands, transfer.bands))?;
        let aim = match settings.quality {
            crate::Quality::Error(error) => error.is_finite() && error > 0.0,
            crate::Quality::Rays(rays) => rays > 0,
        };
        self.header(aim, || "the settings ask for no rays or no error".into())?;
        self.header(settings.time.iter().all(is_amount), || "the time of the settings is none".into())?;
        let edge = match settings.refine {
            crate::Refine::Edge(longest) => longest.is_finite() && longest > 0.0,
            crate::Refine::Auto | crate::Refine::Off => true,
        };
        self.header(edge, || "the settings split triangles at an edge that is no length".into())?;
        self.header(settings.light.iter().all(is_amount), || "the light of the settings has a norm that is none".into())
    }

    fn plan(&self, prt: &Prt) -> Result<(), Error> {
        let (plan, transfer) = (&prt.plan, &prt.transfer);
        self.header(plan.channels == transfer.channels, || {
            format!("the plan has {} channels, the transfer {}", plan.channels, transfer.channels)
        })?;
        self.header(plan.bands == transfer.bands, || {
            format!("the plan has {} bands, the transfer {}", plan.bands, transfer.bands)
        })?;
        let counts = plan.dark_receivers <= plan.shadowed_receivers && plan.shadowed_receivers <= plan.receivers;
        self.header(counts, || "the plan has more shadowed or dark receivers than receivers".into())?;
        let survey = &plan.survey;
        let numbers = plan.rows.iter().map(|row| &row.stake).chain(&survey.coverage).chain(&survey.band_norms);
        self.header(numbers.into_iter().all(is_amount), || "a fact of the plan is no number".into())?;
        let exists = |m: &crate::MeshPlan| (m.mesh as usize) < prt.meshes.len() && m.shadowed <= m.receivers;
        self.header(plan.meshes.iter().all(exists), || {
            "the plan has a mesh that does not exist or does not add up".into()
        })
    }
}

fn is_amount(value: &f32) -> bool {
    value.is_finite() && *value >= 0.0
}

fn is_unit(vector: &[f32]) -> bool {
    let square: f32 = vector.iter().map(|v| v * v).sum();
    (square - 1.0).abs() <= 2.0 * ROUNDING
}
