//! One transfer texture on the GPU, with its levels of detail.

use crate::gloss::FORMAT;
use crate::gloss_rows::{Part, RowSet, Taken, Target, most_rows};
use crate::gloss_shared::{Shared, array_view};
use crate::{Error, Gpu, geometry, gpu_data};
use coeff_io::{Arriving, ArrivingLight, GlossWay, Prt, TransferLevel, TransferSheet};

/// A texture that is kept per light, and the passes that fill it.
#[derive(Debug)]
pub(crate) struct Kept {
    texture: wgpu::Texture,
    /// Of each level its runs.
    sets: Vec<Vec<RowSet>>,
    is_lit: bool,
}

/// One transfer texture.
#[derive(Debug)]
pub(crate) struct Sheet {
    index: u32,
    /// Texels of all levels.
    pub(crate) receivers: u64,
    /// Whether it holds gloss.
    pub(crate) shines: bool,
    detail: wgpu::Buffer,
    diffuse: Kept,
    /// What arrives, with visibility.
    cache: Option<Kept>,
    /// What surfaces send alone.
    bounces: Option<Kept>,
    visibility: Option<wgpu::TextureView>,
    /// For surfaces, in the way that they were made for.
    bindings: Option<(GlossWay, wgpu::BindGroup)>,
}

impl Sheet {
    pub(crate) fn new(gpu: &Gpu, prt: &Prt, shared: &Shared, index: u32) -> Result<Self, Error> {
        let (textures, sheet) = parts(prt, index);
        let detail = gpu_data::Detail {
            density: textures.density(prt, index),
            last: (levels(sheet).len() - 1) as f32,
            ..Default::default()
        };
        let coefficients = prt.transfer.bands.pow(2);
        let part = Part::Diffuse { coefficients, channels: textures.channels };
        let book = prt.codebooks.diffuse.as_ref();
        let taken = |level: &TransferLevel| vec![(part, level.diffuse.clone(), book.cloned(), 0)];
        let usage = wgpu::BufferUsages::UNIFORM;
        Ok(Self {
            index,
            receivers: levels(sheet).iter().map(|level| level.places.len() as u64).sum(),
            shines: sheet.levels[0].arriving.is_some(),
            detail: geometry::buffer(gpu, "levels", bytemuck::bytes_of(&detail), usage)?,
            diffuse: Kept::new(gpu, shared, sheet, 1, &taken)?,
            cache: None,
            bounces: None,
            visibility: None,
            bindings: None,
        })
    }

    pub(crate) fn unlight(&mut self) {
        self.diffuse.is_lit = false;
        self.cache.iter_mut().chain(&mut self.bounces).for_each(|kept| kept.is_lit = false);
    }

    /// Makes what a way reads, where it is not there yet.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, prt: &Prt, shared: &Shared, way: GlossWay) -> Result<(), Error> {
        if self.shines {
            self.prepare_gloss(gpu, prt, shared, way)?;
        }
        if self.bindings.as_ref().is_none_or(|(made, _)| *made != way) {
            self.bindings = Some((way, self.bind(gpu, shared, way)));
        }
        Ok(())
    }

    fn prepare_gloss(&mut self, gpu: &Gpu, prt: &Prt, shared: &Shared, way: GlossWay) -> Result<(), Error> {
        let (_, sheet) = parts(prt, self.index);
        let functions = functions(prt);
        if way == GlossWay::Cache {
            if self.cache.is_none() {
                self.cache = Some(Kept::new(gpu, shared, sheet, functions, &|level| taken(prt, level, true))?);
            }
            return Ok(());
        }
        if self.bounces.is_none() && shared.bounced {
            self.bounces = Some(Kept::new(gpu, shared, sheet, functions, &|level| taken(prt, level, false))?);
        }
        if self.visibility.is_none() {
            self.visibility = Some(visibility(gpu, prt, sheet, functions)?);
        }
        Ok(())
    }

    fn bind(&self, gpu: &Gpu, shared: &Shared, way: GlossWay) -> wgpu::BindGroup {
        let whole = |kept: &Kept| array_view(&kept.texture, 0, kept.texture.mip_level_count());
        let kept = if way == GlossWay::Cache { &self.cache } else { &self.bounces };
        let kept = kept.as_ref().map(whole);
        let diffuse = whole(&self.diffuse);
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            shared.frame.as_entire_binding(),
            shared.lobes.as_entire_binding(),
            shared.light.as_entire_binding(),
            shared.factors.matrix.as_entire_binding(),
            shared.triples.as_entire_binding(),
            wgpu::BindingResource::Sampler(&shared.sampler),
            self.detail.as_entire_binding(),
            view(&diffuse),
            view(kept.as_ref().unwrap_or(&shared.nothing)),
            view(self.visibility.as_ref().unwrap_or(&shared.nothing)),
        ];
        let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("transfer texture"),
            layout: &shared.texel_layout,
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    /// The bindings for surfaces; none before the first frame.
    pub(crate) fn bindings(&self) -> Option<&wgpu::BindGroup> {
        self.bindings.as_ref().map(|(_, bindings)| bindings)
    }

    /// Records what the light has not been put on yet.
    pub(crate) fn record(&mut self, pass: &mut wgpu::ComputePass<'_>, way: GlossWay) {
        self.diffuse.record(pass);
        let kept = if way == GlossWay::Cache { &mut self.cache } else { &mut self.bounces };
        kept.iter_mut().for_each(|kept| kept.record(pass));
    }

    pub(crate) fn write_radiance(&self, gpu: &Gpu, prt: &Prt, index: u32, lit: &ArrivingLight<'_>, way: GlossWay) {
        let kept = if way == GlossWay::Cache { &self.cache } else { &self.bounces };
        let Some(kept) = kept.as_ref().filter(|kept| !kept.is_lit) else { return };
        let (_, sheet) = parts(prt, index);
        for (level, sets) in levels(sheet).iter().zip(&kept.sets) {
            let Some(arriving) = &level.arriving else { continue };
            sets.iter().for_each(|set| set.write_radiance(gpu, &radiance(prt, lit, arriving)));
        }
    }
}

impl Kept {
    fn new(
        gpu: &Gpu,
        shared: &Shared,
        sheet: &TransferSheet,
        functions: u32,
        taken: &dyn Fn(&TransferLevel) -> Vec<Owned>,
    ) -> Result<Self, Error> {
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = texture(gpu, sheet, functions, usage)?;
        let mut sets = Vec::new();
        for (number, level) in (0..).zip(levels(sheet)) {
            let owned = taken(level);
            let view = array_view(&texture, number, 1);
            let parts: Vec<Taken<'_>> = owned
                .iter()
                .map(|(part, table, book, number)| Taken { part: *part, table, book: book.as_ref(), number: *number })
                .collect();
            let widest = parts.iter().map(|part| part.table.columns).max().unwrap_or(1);
            let most = most_rows(gpu, functions, widest);
            let rows = level.places.len() as u32;
            let mut own = Vec::new();
            for first in (0..rows).step_by(most as usize) {
                let run = [first, most.min(rows - first)];
                let mut set = RowSet::new(gpu, &shared.kernels, &shared.factors, functions, run, &parts)?;
                set.send_to(gpu, &shared.kernels, &Target::Texels(&view), (&level.places, level.width))?;
                own.push(set);
            }
            sets.push(own);
        }
        Ok(Self { texture, sets, is_lit: false })
    }

    fn record(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        if !self.is_lit {
            self.sets.iter().flatten().for_each(|set| set.record(pass));
            self.is_lit = true;
        }
    }
}

/// A table with its codebook and its number among those of bounces.
pub(crate) type Owned = (Part, coeff_io::Table, Option<coeff_io::Codebook>, usize);

/// What is kept of what arrives: with visibility, or bounces alone.
fn taken(prt: &Prt, level: &TransferLevel, with_visibility: bool) -> Vec<Owned> {
    level.arriving.as_ref().map_or(Vec::new(), |arriving| tables(prt, arriving, with_visibility))
}

/// The tables of some receivers.
pub(crate) fn tables(prt: &Prt, arriving: &Arriving, with_visibility: bool) -> Vec<Owned> {
    let books = &prt.codebooks;
    let visibility = (Part::Visibility, arriving.visibility.clone(), books.visibility.clone(), 0);
    let bounces = arriving.bounces.iter().enumerate();
    let bounces = bounces.map(|(number, table)| (Part::Bounce, table.clone(), books.bounce.clone(), number));
    with_visibility.then_some(visibility).into_iter().chain(bounces).collect()
}

/// Reads what surfaces send to a row, of the table that is asked for; all tables are added up in the first.
pub(crate) fn radiance<'a>(
    prt: &'a Prt,
    lit: &'a ArrivingLight<'a>,
    arriving: &'a Arriving,
) -> impl Fn(usize, u32, &mut [[f32; 4]]) + 'a {
    move |table, row, out| {
        if table == 0 {
            lit.add_bounces(prt, arriving, row, out);
        }
    }
}

/// Numbers of what arrives per receiver.
pub(crate) fn functions(prt: &Prt) -> u32 {
    prt.gloss.as_ref().map_or(1, |gloss| gloss.bands * gloss.bands)
}

fn parts(prt: &Prt, index: u32) -> (&coeff_io::TransferTextures, &TransferSheet) {
    let textures = prt.transfer_textures.as_ref().expect("there is a sheet");
    (textures, &textures.sheets[index as usize])
}

fn texture(gpu: &Gpu, sheet: &TransferSheet, layers: u32, usage: wgpu::TextureUsages) -> Result<wgpu::Texture, Error> {
    let first = &sheet.levels[0];
    let (side, limit) = (first.width.max(first.height), gpu.limits.max_texture_dimension_2d);
    let what = || format!("a transfer texture of {}x{}", first.width, first.height);
    Error::check_fits(what, u64::from(side), u64::from(limit), "texels along a side", "bake fewer texels")?;
    let most = u64::from(gpu.limits.max_texture_array_layers);
    Error::check_fits(what, u64::from(layers), most, "layers", "bake fewer bands")?;
    Ok(gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("transfer texture"),
        size: wgpu::Extent3d { width: first.width, height: first.height, depth_or_array_layers: layers },
        mip_level_count: levels(sheet).len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage,
        view_formats: &[],
    }))
}

/// The levels that a GPU holds: those that are just half of the one before. Bakes make no others.
fn levels(sheet: &TransferSheet) -> &[TransferLevel] {
    let halves = |pair: &[TransferLevel]| {
        [pair[0].width, pair[0].height] == [2 * pair[1].width, 2 * pair[1].height]
            || [pair[0].width.max(2) / 2, pair[0].height.max(2) / 2] == [pair[1].width, pair[1].height]
    };
    let count = 1 + sheet.levels.windows(2).take_while(|pair| halves(pair)).count();
    &sheet.levels[..count]
}

/// Visibility for products at the fragment, four functions to a layer.
fn visibility(gpu: &Gpu, prt: &Prt, sheet: &TransferSheet, functions: u32) -> Result<wgpu::TextureView, Error> {
    let layers = functions.div_ceil(4);
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = texture(gpu, sheet, layers, usage)?;
    for (number, level) in (0..).zip(levels(sheet)) {
        let Some(arriving) = &level.arriving else { continue };
        let values = arriving.visibility.decode(prt.codebooks.visibility.as_ref());
        let (width, height) = (level.width as usize, level.height as usize);
        let mut texels = vec![half::f16::ZERO; layers as usize * width * height * 4];
        for (row, &place) in values.chunks_exact(functions as usize).zip(&level.places) {
            for (k, value) in row.iter().enumerate() {
                let at = ((k / 4) * width * height + place as usize) * 4 + k % 4;
                texels[at] = half::f16::from_f32(*value);
            }
        }
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: number, ..texture.as_image_copy() },
            bytemuck::cast_slice(&texels),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(level.width * 8),
                rows_per_image: Some(level.height),
            },
            wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: layers },
        );
    }
    Ok(array_view(&texture, 0, texture.mip_level_count()))
}
