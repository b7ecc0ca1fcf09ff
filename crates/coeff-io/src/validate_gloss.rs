//! Whether gloss, transfer textures and codebooks agree with themselves and with the meshes of their file.

use crate::gloss_header::{levels, tables};
use crate::table::Kind;
use crate::validate::{Check, LARGEST_SIDE};
use crate::{Arriving, Bounced, Codebook, Error, Gloss, Prt, Table, TransferLevel, TransferTextures};
use sh_math::Bands;

/// Most means and vectors of a codebook that are combinations of shared ones; a bake makes 8,320 at most.
const MOST_COMBINATIONS: u64 = 1 << 16;

impl Prt {
    /// What is wrong with gloss, transfer textures and codebooks, or does not fit the meshes, in half a sentence; none where all can be drawn.
    ///
    /// A file that was read is sound; renderers ask it of what was made in memory.
    #[must_use]
    pub fn surfaces_fault(&self) -> Option<String> {
        match (Check { chunks: &[] }).surfaces(self) {
            Ok(()) => None,
            Err(Error::Invalid { what, .. }) => Some(what),
            Err(other) => Some(other.to_string()),
        }
    }
}

impl Check<'_> {
    /// All of it.
    pub(crate) fn surfaces(&self, prt: &Prt) -> Result<(), Error> {
        for (index, book) in prt.codebooks.all().enumerate() {
            if let Some(what) = book.fault() {
                self.require_part(Kind::Codebook, index, 0, format!("codebook {index}: {what}"))?;
            }
        }
        self.books(prt)?;
        if let Some(gloss) = &prt.gloss {
            self.bounced(gloss)?;
        }
        self.columns(prt)?;
        self.tables(prt)?;
        if let Some(gloss) = &prt.gloss {
            self.gloss(gloss, prt)?;
        }
        if let Some(textures) = &prt.transfer_textures {
            self.transfer_textures(textures, prt)?;
        }
        self.compressed(prt)
    }

    /// The numbers per receiver of every table, before any is looked into.
    fn columns(&self, prt: &Prt) -> Result<(), Error> {
        let diffuse = u64::from(prt.transfer.bands).pow(2);
        if let Some(table) = &prt.compressed {
            self.wide(table, diffuse * u64::from(prt.transfer.channels), "the transfer of the vertices")?;
        }
        if let Some(textures) = &prt.transfer_textures {
            let channels = matches!(textures.channels, 1 | 3);
            self.header(channels, || format!("transfer textures of {} channels", textures.channels))?;
            for level in levels(prt) {
                self.wide(&level.diffuse, diffuse * u64::from(textures.channels), "the diffuse transfer of a texel")?;
            }
        }
        let of_levels = levels(prt).filter_map(|level| level.arriving.as_ref());
        let of_vertices = prt.gloss.iter().flat_map(|gloss| &gloss.vertices).map(|v| &v.arriving);
        of_vertices.chain(of_levels).try_for_each(|arriving| self.arriving(arriving, prt))
    }

    fn wide(&self, table: &Table, columns: u64, what: &str) -> Result<(), Error> {
        self.header(u64::from(table.columns) == columns, || {
            format!("{what} has {} numbers, not {columns}", table.columns)
        })
    }

    fn arriving(&self, arriving: &Arriving, prt: &Prt) -> Result<(), Error> {
        let Some(gloss) = &prt.gloss else {
            return self.header(false, || "texels hold gloss that the file does not tell of".into());
        };
        self.header(Bands::new(gloss.bands).is_some(), || format!("{} bands of gloss are not supported", gloss.bands))?;
        self.wide(&arriving.visibility, u64::from(gloss.bands).pow(2), "visibility")?;
        let expected = gloss.bounced.as_ref().map_or(0, Bounced::tables);
        self.header(arriving.bounces.len() == expected, || {
            format!("there are {} tables of bounces where {expected} are told of", arriving.bounces.len())
        })?;
        for table in &arriving.bounces {
            let columns = gloss.bounced.as_ref().map_or(0, |bounced| bounced.columns(gloss.bands));
            self.wide(table, columns as u64, "a bounce")?;
            self.header(table.rows == arriving.visibility.rows, || {
                "a table of bounces has other receivers than visibility".into()
            })?;
        }
        Ok(())
    }

    fn tables(&self, prt: &Prt) -> Result<(), Error> {
        for (index, (table, book)) in tables(prt).enumerate() {
            if let Some((byte, what)) = table.fault(book) {
                self.require_part(Kind::Table, index, byte, format!("table {index}: {what}"))?;
            }
        }
        Ok(())
    }

    /// What books grow to in memory is bounded: only that of bounces shares vectors, of which few combinations are made.
    fn books(&self, prt: &Prt) -> Result<(), Error> {
        let plain = [&prt.codebooks.diffuse, &prt.codebooks.visibility];
        self.header(plain.into_iter().flatten().all(|book| book.shared == 0), || {
            "a codebook other than that of bounces shares vectors".into()
        })?;
        let made = |book: &Codebook| u64::from(book.clusters) * (1 + u64::from(book.rank));
        let bounce = prt.codebooks.bounce.as_ref().filter(|book| book.shared > 0);
        self.header(bounce.is_none_or(|book| made(book) <= MOST_COMBINATIONS), || {
            format!("more than {MOST_COMBINATIONS} means and vectors are made of shared ones")
        })
    }

    fn bounced(&self, gloss: &Gloss) -> Result<(), Error> {
        let sound = match &gloss.bounced {
            Some(Bounced::Relightable { bands, channels }) => {
                Bands::new(*bands).is_some() && matches!(channels, 1 | 3) && *bands <= 32
            }
            Some(Bounced::Fixed { light, bounces, .. }) => {
                *bounces > 0 && light.as_flattened().iter().all(|v| v.is_finite())
            }
            None => true,
        };
        self.header(sound && gloss.bands <= 32, || "the bounces of gloss are of no light that is supported".into())
    }

    fn gloss(&self, gloss: &Gloss, prt: &Prt) -> Result<(), Error> {
        let Some(vertices) = &gloss.vertices else { return Ok(()) };
        self.header(vertices.first_row.len() == prt.meshes.len(), || {
            format!("gloss names rows for {} meshes of {}", vertices.first_row.len(), prt.meshes.len())
        })?;
        for (mesh, first) in prt.meshes.iter().zip(&vertices.first_row) {
            let end = first.map_or(0, |first| u64::from(first) + u64::from(mesh.vertices));
            self.header(end <= u64::from(vertices.arriving.visibility.rows), || {
                format!("mesh '{}' has gloss beyond the rows of its table", mesh.name)
            })?;
        }
        Ok(())
    }

    fn transfer_textures(&self, textures: &TransferTextures, prt: &Prt) -> Result<(), Error> {
        let (meshes, named) = (prt.meshes.len(), textures.sheet_of_mesh.len());
        self.header(meshes == named, || {
            format!("the transfer textures name sheets of {named} meshes, but there are {meshes}")
        })?;
        let exists = |sheet: &u32| (*sheet as usize) < textures.sheets.len();
        self.header(textures.sheet_of_mesh.iter().flatten().all(exists), || {
            "a mesh lies on a transfer texture that does not exist".into()
        })?;
        let drawn = textures.sheet_of_mesh.iter().any(Option::is_some);
        self.header(!drawn || !prt.geometry.uv1.is_empty(), || {
            "there are transfer textures but no second texture coordinates".into()
        })?;
        self.header(textures.sheets.iter().all(|sheet| !sheet.levels.is_empty()), || {
            "a transfer texture has no level".into()
        })?;
        for sheet in &textures.sheets {
            let shines = sheet.levels[0].arriving.is_some();
            self.header(sheet.levels.iter().all(|level| level.arriving.is_some() == shines), || {
                "a transfer texture holds gloss in some of its levels only".into()
            })?;
            for pair in sheet.levels.windows(2) {
                let halved = [pair[0].width.div_ceil(2), pair[0].height.div_ceil(2)];
                self.header([pair[1].width, pair[1].height] == halved, || {
                    "a level of a transfer texture is not half of the one before".into()
                })?;
            }
        }
        levels(prt).enumerate().try_for_each(|(index, level)| self.level(index, level))
    }

    fn level(&self, index: usize, level: &TransferLevel) -> Result<(), Error> {
        let sides = 1..=LARGEST_SIDE;
        self.header(sides.contains(&level.width) && sides.contains(&level.height), || {
            format!("level {index} of the transfer textures has {}x{} texels", level.width, level.height)
        })?;
        let texels = u64::from(level.width) * u64::from(level.height);
        let ascending = level.places.windows(2).all(|pair| pair[0] < pair[1]);
        let inside = level.places.last().is_none_or(|&last| u64::from(last) < texels);
        if !ascending || !inside {
            return self.require_part(
                Kind::Places,
                index,
                0,
                format!("the texels of level {index} do not ascend within {}x{}", level.width, level.height),
            );
        }
        let rows = level.places.len() as u64;
        let same = |table: &Table| u64::from(table.rows) == rows;
        self.header(same(&level.diffuse) && level.arriving.iter().all(|a| same(&a.visibility)), || {
            format!("a table of level {index} has other rows than its {rows} texels")
        })
    }

    /// A clustered transfer is what the values say.
    fn compressed(&self, prt: &Prt) -> Result<(), Error> {
        let Some(table) = &prt.compressed else { return Ok(()) };
        let fits = u64::from(table.rows) == prt.geometry.positions.len() as u64;
        self.header(fits, || format!("the clustered transfer has {} rows", table.rows))?;
        self.header(table.decode(prt.codebooks.diffuse.as_ref()) == prt.transfer.values, || {
            "the transfer of the vertices is not what its clustered form says".into()
        })
    }
}
