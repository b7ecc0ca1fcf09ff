//! Numbers out of buffers, every range checked.

use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, buffer};

use super::document::Document;
use crate::Error;

/// Most elements of an accessor without data, all zeros: the only one whose size no bytes of the file justify.
const MAX_ZEROS: usize = 1 << 20;

/// Where the elements of an accessor lie in a buffer view.
struct Layout<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl Document<'_> {
    /// Number of elements of an accessor.
    pub(super) fn count(&self, index: Index<Accessor>) -> usize {
        self.root.accessors[index.value()].count.0 as usize
    }

    /// Number of components of one element.
    pub(super) fn components(&self, index: Index<Accessor>) -> usize {
        match self.root.accessors[index.value()].type_ {
            Checked::Valid(Type::Scalar) => 1,
            Checked::Valid(Type::Vec2) => 2,
            Checked::Valid(Type::Vec3) => 3,
            Checked::Valid(Type::Vec4 | Type::Mat2) => 4,
            Checked::Valid(Type::Mat3) => 9,
            Checked::Valid(Type::Mat4) => 16,
            Checked::Invalid => 0,
        }
    }

    /// All elements as N floats each; normalised integers become [0, 1] or [-1, 1] (glTF 2.0, 3.6.2.2), others
    /// (KHR_mesh_quantization) keep their value.
    pub(super) fn floats<const N: usize>(&self, index: Index<Accessor>) -> Result<Vec<[f32; N]>, Error> {
        let accessor = &self.root.accessors[index.value()];
        self.expect_components(index, N)?;
        let component = self.component(index)?;
        if component == ComponentType::U32 {
            return Err(self.invalid(object(index), "32-bit integers where a vertex attribute is wanted"));
        }
        let normalized = accessor.normalized;
        self.elements(index, |bytes| {
            std::array::from_fn(|k| as_float(&bytes[k * component.size()..], component, normalized))
        })
    }

    /// Values that a decoder gave as the integers of an accessor, normalised where it says so.
    pub(super) fn normalized<const N: usize>(
        &self,
        index: Index<Accessor>,
        mut values: Vec<[f32; N]>,
    ) -> Result<Vec<[f32; N]>, Error> {
        let largest = match self.component(index)? {
            ComponentType::I8 => 127.0,
            ComponentType::U8 => 255.0,
            ComponentType::I16 => 32_767.0,
            ComponentType::U16 => 65_535.0,
            ComponentType::U32 | ComponentType::F32 => return Ok(values),
        };
        if self.root.accessors[index.value()].normalized {
            values.iter_mut().flatten().for_each(|value| *value = (*value / largest).max(-1.0));
        }
        Ok(values)
    }

    /// All elements of a scalar accessor of unsigned integers.
    pub(super) fn integers(&self, index: Index<Accessor>) -> Result<Vec<u32>, Error> {
        self.expect_components(index, 1)?;
        let component = self.component(index)?;
        if !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Err(self.invalid(object(index), format!("{component:?} where unsigned integers are wanted")));
        }
        self.elements(index, |bytes| as_integer(bytes, component))
    }

    fn expect_components(&self, index: Index<Accessor>, wanted: usize) -> Result<(), Error> {
        match self.components(index) {
            found if found == wanted => Ok(()),
            found => {
                Err(self.invalid(object(index), format!("{found} components an element where {wanted} are wanted")))
            }
        }
    }

    fn component(&self, index: Index<Accessor>) -> Result<ComponentType, Error> {
        match self.root.accessors[index.value()].component_type {
            Checked::Valid(component) => Ok(component.0),
            Checked::Invalid => Err(self.invalid(object(index), "unknown componentType")),
        }
    }

    /// Reads every element with `read`, which gets at least the bytes of one element, and lays sparse values over.
    fn elements<T: Clone>(&self, index: Index<Accessor>, read: impl Fn(&[u8]) -> T) -> Result<Vec<T>, Error> {
        let accessor = &self.root.accessors[index.value()];
        let size = self.components(index) * self.component(index)?.size();
        let count = self.count(index);
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                let layout = self.layout(&object(index), view, offset, count, size)?;
                (0..count).map(|i| read(&layout.bytes[i * layout.stride..])).collect()
            }
            None if count <= MAX_ZEROS => vec![read(&[0; 64]); count],
            None => {
                return Err(self.invalid(
                    object(index),
                    format!("{count} elements without a bufferView; at most {MAX_ZEROS} may be zeros"),
                ));
            }
        };
        if accessor.sparse.is_some() {
            self.lay_sparse(index, size, &mut values, read)?;
        }
        Ok(values)
    }

    /// Replaces the elements that the sparse part of an accessor lists.
    fn lay_sparse<T>(
        &self,
        index: Index<Accessor>,
        size: usize,
        values: &mut [T],
        read: impl Fn(&[u8]) -> T,
    ) -> Result<(), Error> {
        let Some(sparse) = &self.root.accessors[index.value()].sparse else { return Ok(()) };
        let object = format!("{}.sparse", object(index));
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return Err(self.invalid(object, "unknown componentType of the indices"));
        };
        let count = sparse.count.0 as usize;
        if count > values.len() {
            return Err(self.invalid(object, format!("count {count} of {} elements", values.len())));
        }
        let (where_, what) = (&sparse.indices, &sparse.values);
        let places = self.layout(&object, where_.buffer_view, where_.byte_offset.0, count, kind.0.size())?;
        let news = self.layout(&object, what.buffer_view, what.byte_offset.0, count, size)?;
        for i in 0..count {
            let place = as_integer(&places.bytes[i * places.stride..], kind.0) as usize;
            let n = values.len();
            let slot = values
                .get_mut(place)
                .ok_or_else(|| self.invalid(object.as_str(), format!("index {place} of {n} elements")))?;
            *slot = read(&news.bytes[i * news.stride..]);
        }
        Ok(())
    }

    /// Checks that `count` elements of `size` bytes fit into a view from `offset` on.
    fn layout(
        &self,
        object: &str,
        view: Index<buffer::View>,
        offset: u64,
        count: usize,
        size: usize,
    ) -> Result<Layout<'_>, Error> {
        let bytes = self.view(view)?;
        let stride = self.stride(view, size);
        if stride < size {
            return Err(self.invalid(object, format!("byteStride {stride} is less than an element of {size} bytes")));
        }
        let end = (count.saturating_sub(1) as u64)
            .checked_mul(stride as u64)
            .and_then(|n| n.checked_add(if count == 0 { 0 } else { size as u64 }))
            .and_then(|n| n.checked_add(offset));
        match end.filter(|end| *end <= bytes.len() as u64) {
            Some(_) => Ok(Layout { bytes: &bytes[offset as usize..], stride }),
            None => {
                let what = format!("{count} elements of {size} bytes from {offset} on do not fit");
                Err(self.invalid(object, format!("{what} into bufferView {} of {} bytes", view.value(), bytes.len())))
            }
        }
    }
}

fn object(index: Index<Accessor>) -> String {
    format!("accessors[{}]", index.value())
}

fn as_float(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, largest) = match component {
        ComponentType::I8 => (f32::from(bytes[0] as i8), 127.0),
        ComponentType::U8 => (f32::from(bytes[0]), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32_767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65_535.0),
        ComponentType::U32 | ComponentType::F32 => {
            return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        }
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}

fn as_integer(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 | ComponentType::I8 => u32::from(bytes[0]),
        ComponentType::U16 | ComponentType::I16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        ComponentType::U32 | ComponentType::F32 => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}
