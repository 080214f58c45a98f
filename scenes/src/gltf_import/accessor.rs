//! Reads accessors into plain vectors: any component type, stride and sparse overlay. Every range
//! is checked before it is read. (The readers of the gltf crate assert and overflow on malformed
//! files.)

use gltf::json::{
    Index,
    accessor::{Accessor, ComponentType, Type, sparse::Sparse},
    validation::Checked,
};

use super::file::File;
use crate::SceneError;

/// The most elements of an accessor without a buffer view. Such an accessor costs its file nothing.
const MAX_ZEROED: u64 = 1 << 22;

/// A run of equally spaced elements inside a buffer view.
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
}

impl Run<'_> {
    fn element(&self, ix: usize) -> &[u8] {
        &self.bytes[ix * self.stride..]
    }
}

impl File {
    /// Reads `N` floats per element. Integers are normalised where the accessor asks for it.
    pub(super) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
    ) -> Result<Vec<[f32; N]>, SceneError> {
        let (accessor, component) = self.accessor(index, N)?;
        let size = component.size();
        let decode = |bytes: &[u8]| -> [f32; N] {
            std::array::from_fn(|i| {
                let at = &bytes[i * size..];
                float(at, component, accessor.normalized)
            })
        };
        self.elements(index, accessor, N * size, [0.0; N], decode)
    }

    /// Reads one unsigned integer per element.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>, SceneError> {
        let (accessor, component) = self.accessor(index, 1)?;
        use ComponentType::{U8, U16, U32};
        if !matches!(component, U8 | U16 | U32) {
            return Err(self.invalid(
                format!("accessors[{index}].componentType"),
                component.as_gl_enum(),
                "5121, 5123 or 5125 (unsigned integers)",
            ));
        }
        let decode = |bytes: &[u8]| unsigned(bytes, component);
        self.elements(index, accessor, component.size(), 0, decode)
    }

    /// The accessor and its component type, after checking that each element has `components`
    /// components.
    fn accessor(
        &self,
        index: Index<Accessor>,
        components: usize,
    ) -> Result<(&Accessor, ComponentType), SceneError> {
        let field = format!("accessors[{index}]");
        let accessor =
            self.root.get(index).ok_or_else(|| self.invalid(&field, "missing", "present"))?;
        let (Checked::Valid(component), Checked::Valid(kind)) =
            (accessor.component_type, accessor.type_)
        else {
            return Err(self.invalid(&field, "of unknown type", "a glTF accessor"));
        };
        let accepted = match components {
            1 => Type::Scalar,
            2 => Type::Vec2,
            3 => Type::Vec3,
            4 => Type::Vec4,
            _ => Type::Mat4,
        };
        if kind != accepted {
            let name = |t: Type| format!("{t:?}").to_uppercase();
            return Err(self.invalid(format!("{field}.type"), name(kind), name(accepted)));
        }
        Ok((accessor, component.0))
    }

    fn elements<T: Clone>(
        &self,
        index: Index<Accessor>,
        accessor: &Accessor,
        size: usize,
        zero: T,
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, SceneError> {
        let field = format!("accessors[{index}]");
        let count = accessor.count.0;
        if count == 0 || count > u64::from(u32::MAX) {
            return Err(self.invalid(format!("{field}.count"), count, "1 to 4294967295"));
        }
        let mut values = if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
            let run = self.run(&field, view.value(), offset, count, size)?;
            (0..run.count).map(|ix| decode(run.element(ix))).collect()
        } else if count <= MAX_ZEROED {
            vec![zero; count as usize]
        } else {
            let accepted = format!("at most {MAX_ZEROED} without a bufferView");
            return Err(self.invalid(format!("{field}.count"), count, accepted));
        };
        if let Some(sparse) = &accessor.sparse {
            self.overlay(&format!("{field}.sparse"), sparse, size, &mut values, decode)?;
        }
        Ok(values)
    }

    /// Replaces the elements that a sparse accessor lists.
    fn overlay<T>(
        &self,
        field: &str,
        sparse: &Sparse,
        size: usize,
        values: &mut [T],
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<(), SceneError> {
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(self.invalid(field, "of unknown index type", "5121, 5123 or 5125"));
        };
        let (at, with) = (&sparse.indices, &sparse.values);
        let count = sparse.count.0;
        let (at_view, with_view) = (at.buffer_view.value(), with.buffer_view.value());
        let index_size = component.0.size();
        let at = self.run(field, at_view, at.byte_offset.0, count, index_size)?;
        let with = self.run(field, with_view, with.byte_offset.0, count, size)?;
        for ix in 0..at.count {
            let element = unsigned(at.element(ix), component.0);
            let elements = values.len();
            let slot = values.get_mut(element as usize).ok_or_else(|| {
                self.invalid(format!("{field}.indices"), element, format!("below {elements}"))
            })?;
            *slot = decode(with.element(ix));
        }
        Ok(())
    }

    /// `count` elements of `size` bytes from `offset` of a view, after checking that they lie
    /// inside it.
    fn run(
        &self,
        field: &str,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
    ) -> Result<Run<'_>, SceneError> {
        let bytes = self.view(view)?;
        let stride = self.root.buffer_views[view].byte_stride.map_or(0, |s| s.0);
        let stride = if stride == 0 { size } else { stride };
        if stride < size {
            return Err(self.invalid(
                format!("bufferViews[{view}].byteStride"),
                stride,
                format!("at least {size}, the bytes of an element of {field}"),
            ));
        }
        let last = (stride as u64).checked_mul(count.saturating_sub(1));
        let end = last.and_then(|last| last.checked_add(offset)?.checked_add(size as u64));
        match end {
            Some(end) if end <= bytes.len() as u64 => {
                Ok(Run { bytes: &bytes[offset as usize..], stride, count: count as usize })
            }
            _ => Err(self.invalid(
                field,
                format!("{count} elements of {stride} bytes from {offset}"),
                format!("inside bufferViews[{view}] of {} bytes", bytes.len()),
            )),
        }
    }
}

/// The first bytes as a little-endian array. The caller has checked the range.
fn head<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

fn unsigned(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 | ComponentType::I8 => u32::from(bytes[0]),
        ComponentType::U16 | ComponentType::I16 => u32::from(u16::from_le_bytes(head(bytes))),
        ComponentType::U32 | ComponentType::F32 => u32::from_le_bytes(head(bytes)),
    }
}

/// The integer that stands for 1 in a normalised type; `None` for floats.
pub(super) fn largest(component: ComponentType) -> Option<f32> {
    match component {
        ComponentType::F32 => None,
        ComponentType::U8 => Some(255.0),
        ComponentType::I8 => Some(127.0),
        ComponentType::U16 => Some(65_535.0),
        ComponentType::I16 => Some(32_767.0),
        ComponentType::U32 => Some(u32::MAX as f32),
    }
}

/// One component as a float. Normalised integers follow glTF's equations (section 3.11).
fn float(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let value = match component {
        ComponentType::F32 => f32::from_le_bytes(head(bytes)),
        ComponentType::U8 => f32::from(bytes[0]),
        ComponentType::I8 => f32::from(i8::from_le_bytes(head(bytes))),
        ComponentType::U16 => f32::from(u16::from_le_bytes(head(bytes))),
        ComponentType::I16 => f32::from(i16::from_le_bytes(head(bytes))),
        ComponentType::U32 => u32::from_le_bytes(head(bytes)) as f32,
    };
    match largest(component).filter(|_| normalized) {
        Some(max) => (value / max).max(-1.0),
        None => value,
    }
}
