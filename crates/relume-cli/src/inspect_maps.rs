//! What `relume inspect` tells of light maps and irradiance volumes.

use crate::columns::{bytes, count};
use crate::inspect::elements;
use coeff_io::{Inspection, Kind, MapLight, MapsHeader, VolumeHeader, basis_of};
use serde_json::{Value, json};

const VOLUME: [Kind; 5] =
    [Kind::VolumeNodes, Kind::VolumeValues, Kind::VolumePositions, Kind::VolumeValidity, Kind::VolumeDistances];

fn size(seen: &Inspection, kinds: &[Kind]) -> u64 {
    kinds.iter().map(|kind| elements(seen, *kind, 1)).sum()
}

fn light_text(light: &MapLight) -> String {
    match light {
        MapLight::Fixed { probe, bands } => format!("of {probe} in {bands} bands"),
        MapLight::Relightable { bands } => format!("of any light of {bands} bands"),
    }
}

fn light_json(light: &MapLight) -> Value {
    match light {
        MapLight::Fixed { probe, bands } => json!({ "kind": "fixed", "probe": probe, "bands": bands }),
        MapLight::Relightable { bands } => json!({ "kind": "relightable", "bands": bands }),
    }
}

/// Basis, light, meshes, and per sheet its sides, encoding and bytes, on one line.
pub(crate) fn maps_text(maps: &MapsHeader, seen: &Inspection) -> String {
    let basis = basis_of(&maps.basis).map_or(maps.basis.as_str(), |basis| basis.name());
    let lengths = seen.chunks.iter().filter(|chunk| chunk.kind == Kind::Sheet).map(|chunk| chunk.length);
    let sheet = |(sheet, length): (&coeff_io::SheetHeader, u64)| {
        let channels = if sheet.channels == 1 { "1 channel" } else { "3 channels" };
        let encoding = sheet.encoding.id();
        format!("{}x{} {encoding} {} layers of {channels}, {}", sheet.width, sheet.height, sheet.layers, bytes(length))
    };
    let sheets: Vec<String> = maps.sheets.iter().zip(lengths).map(sheet).collect();
    let meshes = maps.sheet_of_mesh.iter().flatten().count();
    format!("{basis}, {}, on {meshes} meshes: {}", light_text(&maps.light), sheets.join("; "))
}

/// Cells, probes, light and bytes, on one line.
pub(crate) fn volume_text(volume: &VolumeHeader, seen: &Inspection) -> String {
    let [x, y, z] = volume.cells;
    let cells = count(elements(seen, Kind::VolumeNodes, 32));
    let probes = count(elements(seen, Kind::VolumePositions, 12));
    let channels = if volume.channels == 1 { "1 channel" } else { "3 channels" };
    let distances = match volume.resolution {
        0 => "no distances".into(),
        side => format!("distances {side}x{side}"),
    };
    let all = bytes(size(seen, &VOLUME));
    let light = light_text(&volume.light);
    format!("{x}x{y}x{z}, {cells} cells, {probes} probes, {light}, {channels}, {distances}, {all}")
}

pub(crate) fn maps_json(maps: &MapsHeader, seen: &Inspection) -> Value {
    let lengths = seen.chunks.iter().filter(|chunk| chunk.kind == Kind::Sheet).map(|chunk| chunk.length);
    let sheet = |(sheet, length): (&coeff_io::SheetHeader, u64)| {
        json!({
            "width": sheet.width, "height": sheet.height, "layers": sheet.layers, "channels": sheet.channels,
            "encoding": sheet.encoding.id(), "bytes": length,
        })
    };
    json!({
        "basis": maps.basis,
        "light": light_json(&maps.light),
        "sheets": maps.sheets.iter().zip(lengths).map(sheet).collect::<Vec<_>>(),
        "meshes": maps.sheet_of_mesh.iter().flatten().count(),
        "bytes": size(seen, &[Kind::Sheet]),
    })
}

pub(crate) fn volume_json(volume: &VolumeHeader, seen: &Inspection) -> Value {
    json!({
        "origin": volume.origin, "spacing": volume.spacing, "coarse_cells": volume.cells,
        "cells": elements(seen, Kind::VolumeNodes, 32),
        "probes": elements(seen, Kind::VolumePositions, 12),
        "light": light_json(&volume.light),
        "channels": volume.channels,
        "distance_texels": volume.resolution,
        "bytes": size(seen, &VOLUME),
    })
}
