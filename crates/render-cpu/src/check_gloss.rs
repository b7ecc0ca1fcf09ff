//! Whether gloss, transfer textures and their tables fit the meshes, before a sample indexes them.

use coeff_io::{Arriving, Bounced, Codebook, Form, Gloss, Prt, Table, TransferLevel, TransferTextures};
use sh_math::Bands;

/// What does not fit, in half a sentence; none where all does.
pub(crate) fn fault(prt: &Prt) -> Option<String> {
    let books = prt.codebooks.all();
    let broken = books.into_iter().position(|book| {
        let vectors = (u64::from(book.rank) + 1).saturating_mul(u64::from(book.clusters));
        vectors.saturating_mul(2 * u64::from(book.columns)) != book.bytes.len() as u64
    });
    if let Some(index) = broken {
        return Some(format!("codebook {index} is not of its length"));
    }
    of_gloss(prt).or_else(|| prt.transfer_textures.as_ref().and_then(|textures| of_textures(prt, textures)))
}

fn of_gloss(prt: &Prt) -> Option<String> {
    let gloss = prt.gloss.as_ref()?;
    if Bands::new(gloss.bands).is_none() {
        return Some(format!("{} bands of gloss are not supported", gloss.bands));
    }
    if let Some(Bounced::Relightable { bands, channels }) = &gloss.bounced
        && (Bands::new(*bands).is_none() || !matches!(channels, 1 | 3))
    {
        return Some(format!("bounces of {bands} bands and {channels} channels"));
    }
    let vertices = gloss.vertices.as_ref()?;
    if vertices.first_row.len() != prt.meshes.len() {
        return Some(format!("gloss of {} meshes of {}", vertices.first_row.len(), prt.meshes.len()));
    }
    let rows = u64::from(vertices.arriving.visibility.rows);
    let positions = prt.geometry.positions.len() as u64;
    let mut meshes = prt.meshes.iter().zip(&vertices.first_row);
    let beyond = meshes.find(|(mesh, first)| {
        let end = |first: u32| u64::from(first) + u64::from(mesh.vertices);
        first.is_some_and(|first| end(first) > rows || end(mesh.first_vertex) > positions)
    });
    match beyond {
        Some((mesh, _)) => Some(format!("mesh `{}` has gloss beyond the rows of its table", mesh.name)),
        None => of_arriving(prt, gloss, &vertices.arriving, rows),
    }
}

fn of_textures(prt: &Prt, textures: &TransferTextures) -> Option<String> {
    if !matches!(textures.channels, 1 | 3) || textures.sheet_of_mesh.len() != prt.meshes.len() {
        let (channels, named) = (textures.channels, textures.sheet_of_mesh.len());
        return Some(format!("transfer textures of {channels} channels for {named} of {} meshes", prt.meshes.len()));
    }
    let mut named = textures.sheet_of_mesh.iter().flatten();
    if named.any(|&sheet| sheet as usize >= textures.sheets.len() || prt.geometry.uv1.is_empty()) {
        return Some("a mesh lies on a transfer texture that does not exist, or has no coordinates there".into());
    }
    textures.sheets.iter().enumerate().find_map(|(index, sheet)| {
        let Some(first) = sheet.levels.first() else {
            return Some(format!("transfer texture {index} has no level"));
        };
        if sheet.levels.iter().any(|level| level.arriving.is_some() != first.arriving.is_some()) {
            return Some(format!("transfer texture {index} shines in some of its levels only"));
        }
        sheet.levels.iter().find_map(|level| of_level(prt, textures, level))
    })
}

fn of_level(prt: &Prt, textures: &TransferTextures, level: &TransferLevel) -> Option<String> {
    let texels = u64::from(level.width) * u64::from(level.height);
    if texels == 0 || texels > u64::from(u32::MAX) || level.places.iter().any(|&place| u64::from(place) >= texels) {
        return Some(format!("a level of {} x {} has texels beyond it", level.width, level.height));
    }
    let rows = level.places.len() as u64;
    let columns = u64::from(prt.transfer.bands).pow(2) * u64::from(textures.channels);
    of_table(&level.diffuse, [rows, columns], prt.codebooks.diffuse.as_ref()).or_else(|| {
        match (&level.arriving, &prt.gloss) {
            (Some(arriving), Some(gloss)) => of_arriving(prt, gloss, arriving, rows),
            (Some(_), None) => Some("texels hold gloss that the file does not tell of".into()),
            (None, _) => None,
        }
    })
}

fn of_arriving(prt: &Prt, gloss: &Gloss, arriving: &Arriving, rows: u64) -> Option<String> {
    let functions = u64::from(gloss.bands).pow(2);
    if arriving.bounces.len() != gloss.bounced.as_ref().map_or(0, Bounced::tables) {
        return Some(format!("{} tables of bounces where others are told of", arriving.bounces.len()));
    }
    let columns = gloss.bounced.as_ref().map_or(0, |bounced| bounced.columns(gloss.bands)) as u64;
    let bounce = |table| of_table(table, [rows, columns], prt.codebooks.bounce.as_ref());
    of_table(&arriving.visibility, [rows, functions], prt.codebooks.visibility.as_ref())
        .or_else(|| arriving.bounces.iter().find_map(bounce))
}

/// Rows, columns, bytes and clusters of a table.
fn of_table(table: &Table, [rows, columns]: [u64; 2], book: Option<&Codebook>) -> Option<String> {
    let bytes = match (table.form, book) {
        (Form::F32, _) => rows * columns * 4,
        (Form::F16, _) => rows * columns * 2,
        (Form::Clustered, Some(book)) => rows * 2 * (1 + u64::from(book.rank)),
        (Form::Clustered, None) => return Some("a clustered table has no codebook".into()),
    };
    let sized = [u64::from(table.rows), u64::from(table.columns), table.bytes.len() as u64] == [rows, columns, bytes];
    let clusters = |book: &Codebook| {
        let inside = (0..table.rows).all(|row| u32::from(table.cluster(row)) < book.clusters);
        u64::from(book.columns) == columns && inside
    };
    let sound = sized && (table.form != Form::Clustered || book.is_some_and(clusters));
    (!sound).then(|| format!("a table of {} x {} does not hold {rows} x {columns} numbers", table.rows, table.columns))
}
