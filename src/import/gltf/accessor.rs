//! A reader of accessors in which every size, offset and index is checked before a byte is read.
//!
//! Elements are decoded when they are asked for, so a file that claims giant counts costs nothing until the
//! claim has been compared with the bytes that are there.

use super::buffers::Buffers;
use super::document::Document;
use super::draco::Attribute;
use crate::import::ImportError;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;

/// An accessor whose bytes are known to be there.
pub struct Accessor<'a> {
    /// What it is, for sentences: `accessor 3 (POSITION of mesh "Fox")`.
    label: String,
    /// The bytes from its first element on; `None` where all elements are zero.
    dense: Option<&'a [u8]>,
    stride: usize,
    count: usize,
    shape: Type,
    component: ComponentType,
    normalized: bool,
    sparse: Option<Sparse<'a>>,
}

/// Elements that replace those of the dense part.
struct Sparse<'a> {
    /// Ascending element numbers.
    elements: Vec<u32>,
    values: &'a [u8],
}

impl<'a> Accessor<'a> {
    /// Finds accessor `index` and checks its sizes; `purpose` says what it is for, in sentences.
    pub fn open(document: &Document, buffers: &'a Buffers, index: usize, purpose: &str) -> Result<Self, ImportError> {
        Self::over(document, buffers, index, purpose, None)
    }

    /// The same for an accessor whose values were decoded apart from it: they stand in for its own, with their own
    /// number and type of component.
    pub fn over(
        document: &Document,
        buffers: &'a Buffers,
        index: usize,
        purpose: &str,
        decoded: Option<&'a Attribute>,
    ) -> Result<Self, ImportError> {
        let label = format!("accessor {index} of {} ({purpose})", document.name);
        let wrong = |what: &str| ImportError(format!("{label} {what}; the file is damaged, export it again"));
        let entry = document.accessors.get(index).ok_or_else(|| wrong("does not exist"))?;
        let Checked::Valid(component) = entry.component_type else { return Err(wrong("has an unknown componentType")) };
        let Checked::Valid(shape) = entry.type_ else { return Err(wrong("has an unknown type")) };
        let component = decoded.map_or(component.0, |values| values.component);
        if decoded.is_some_and(|values| values.width != shape.multiplicity()) {
            return Err(wrong(&format!("was compressed as something else than {shape:?}")));
        }
        let size = component.size() * shape.multiplicity();
        // Vertex and face numbers are 32 bits wide throughout.
        let count = u32::try_from(entry.count.0).map_err(|_| wrong("claims more elements than can be numbered"))?;
        let count = decoded.map_or(count as usize, |values| values.bytes.len() / size);
        let mut stride = size;
        let dense = match (decoded, entry.buffer_view) {
            (Some(values), _) => Some(values.bytes.as_slice()),
            (None, None) => None,
            (None, Some(view)) => {
                let bytes = buffers.view(document, view.value())?;
                let given = document.views.get(view.value()).and_then(|v| v.byte_stride).map_or(0, |s| s.0);
                if given != 0 {
                    stride = given;
                }
                if stride < size {
                    return Err(wrong(&format!("has elements of {size} bytes at a stride of {stride}")));
                }
                let offset = entry.byte_offset.map_or(0, |o| o.0);
                let needed = span(count, stride, size).saturating_add(offset);
                if needed > bytes.len() as u64 {
                    return Err(wrong(&format!(
                        "needs {needed} bytes for its {count} elements, but its buffer view has {}",
                        bytes.len()
                    )));
                }
                bytes.get(usize::try_from(offset).unwrap_or(usize::MAX)..)
            }
        };
        let sparse = match &entry.sparse {
            Some(sparse) => Some(Sparse::open(document, buffers, sparse, count, size, &wrong)?),
            None => None,
        };
        Ok(Self { label, dense, stride, count, shape, component, normalized: entry.normalized, sparse })
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.count
    }

    /// What it is, for sentences.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// True if every value is 0, because the file stores none.
    pub fn is_zero(&self) -> bool {
        self.dense.is_none() && self.sparse.as_ref().is_none_or(|s| s.elements.is_empty())
    }

    /// Refuses any other shape of element.
    pub fn expect_shape(&self, shape: Type) -> Result<(), ImportError> {
        if self.shape == shape {
            return Ok(());
        }
        Err(self.wrong(&format!("has elements of type {:?} where {shape:?} is needed", self.shape)))
    }

    /// Refuses a number of elements other than `count`, which is that of `whose`.
    pub fn expect_len(&self, count: usize, whose: &str) -> Result<(), ImportError> {
        if self.count == count {
            return Ok(());
        }
        Err(self.wrong(&format!("has {} elements, but {whose} has {count}", self.count)))
    }

    /// Reads element `element` as `N` numbers (integers as fractions where the accessor is normalised). `N` must
    /// be the multiplicity of its shape; numbers that the element lacks are 0.
    pub fn numbers<const N: usize>(&self, element: usize) -> Result<[f64; N], ImportError> {
        let mut out = [0.0; N];
        if let Some(bytes) = self.element(element) {
            for (k, chunk) in bytes.chunks_exact(self.component.size()).take(N).enumerate() {
                let value = self.number(chunk);
                if !value.is_finite() {
                    return Err(self.wrong(&format!("holds a value that is not a finite number, in element {element}")));
                }
                out[k] = value;
            }
        }
        Ok(out)
    }

    /// Reads element `element` as `N` whole numbers: indices and joints.
    pub fn integers<const N: usize>(&self, element: usize) -> Result<[u32; N], ImportError> {
        let mut out = [0; N];
        if let Some(bytes) = self.element(element) {
            for (k, chunk) in bytes.chunks_exact(self.component.size()).take(N).enumerate() {
                let value = self.raw(chunk);
                // Some exporters write joints as floats.
                if !(value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value)) {
                    return Err(
                        self.wrong(&format!("holds {value} where a whole number is needed, in element {element}"))
                    );
                }
                out[k] = value as u32;
            }
        }
        Ok(out)
    }

    /// An error about this accessor: `what` is the predicate of the sentence.
    pub fn wrong(&self, what: &str) -> ImportError {
        ImportError(format!("{} {what}; the file is damaged, export it again", self.label))
    }

    /// The bytes of an element; `None` for one that is all zero.
    fn element(&self, element: usize) -> Option<&'a [u8]> {
        let size = self.component.size() * self.shape.multiplicity();
        if let Some(sparse) = &self.sparse
            && let Ok(at) = sparse.elements.binary_search(&u32::try_from(element).unwrap_or(u32::MAX))
        {
            return sparse.values.get(at * size..(at + 1) * size);
        }
        let start = element.checked_mul(self.stride)?;
        self.dense?.get(start..start.checked_add(size)?)
    }

    fn raw(&self, bytes: &[u8]) -> f64 {
        match (self.component, bytes) {
            (ComponentType::I8, &[a]) => f64::from(a as i8),
            (ComponentType::U8, &[a]) => f64::from(a),
            (ComponentType::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (ComponentType::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (ComponentType::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (ComponentType::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => 0.0,
        }
    }

    /// glTF 2.0, §3.6.2.2: an integer as the fraction that it stands for.
    fn number(&self, bytes: &[u8]) -> f64 {
        let raw = self.raw(bytes);
        match (self.normalized, self.component) {
            (true, ComponentType::I8) => (raw / 127.0).max(-1.0),
            (true, ComponentType::U8) => raw / 255.0,
            (true, ComponentType::I16) => (raw / 32_767.0).max(-1.0),
            (true, ComponentType::U16) => raw / 65_535.0,
            _ => raw,
        }
    }
}

impl<'a> Sparse<'a> {
    fn open(
        document: &Document,
        buffers: &'a Buffers,
        sparse: &gltf::json::accessor::sparse::Sparse,
        elements: usize,
        size: usize,
        wrong: &impl Fn(&str) -> ImportError,
    ) -> Result<Self, ImportError> {
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(wrong("has sparse indices of an unknown componentType"));
        };
        let width = component.0.size();
        let count = usize::try_from(sparse.count.0).ok().filter(|&count| count <= elements);
        let count = count.ok_or_else(|| wrong("replaces more elements than it has"))?;
        let indices = buffers.view(document, sparse.indices.buffer_view.value())?;
        let indices = tail(indices, sparse.indices.byte_offset.0, span(count, width, width))
            .ok_or_else(|| wrong("has sparse indices beyond their buffer view"))?;
        let values = buffers.view(document, sparse.values.buffer_view.value())?;
        let values = tail(values, sparse.values.byte_offset.0, span(count, size, size))
            .ok_or_else(|| wrong("has sparse values beyond their buffer view"))?;
        let mut ascending = Vec::with_capacity(count);
        for bytes in indices.chunks_exact(width).take(count) {
            let element = bytes.iter().rev().fold(0_u32, |all, &b| (all << 8) | u32::from(b));
            if element as usize >= elements {
                return Err(wrong(&format!("replaces element {element}, but has only {elements}")));
            }
            if ascending.last().is_some_and(|&last| last >= element) {
                return Err(wrong("has sparse indices that do not ascend"));
            }
            ascending.push(element);
        }
        Ok(Self { elements: ascending, values })
    }
}

/// Bytes from the first to the last of `count` elements.
fn span(count: usize, stride: usize, size: usize) -> u64 {
    match count.checked_sub(1) {
        None => 0,
        Some(gaps) => (gaps as u64).saturating_mul(stride as u64).saturating_add(size as u64),
    }
}

/// The bytes from `offset` on, if there are `needed` of them.
fn tail(bytes: &[u8], offset: u64, needed: u64) -> Option<&[u8]> {
    let tail = bytes.get(usize::try_from(offset).ok()?..)?;
    (tail.len() as u64 >= needed).then_some(tail)
}
