//! Encoder for one row of a topic.

use spandrel_model::frames::{Rotation, Vec3};

/// Encoder for one row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogRow {
    bytes: Vec<u8>,
}

impl LogRow {
    /// Starts a row with its timestamp in microseconds.
    #[must_use]
    pub fn at(us: u64) -> Self {
        Self { bytes: us.to_le_bytes().to_vec() }
    }

    /// Appends a `double`.
    pub fn f64(&mut self, value: f64) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// Appends a `float`, converted from `f64`.
    pub fn f32(&mut self, value: f64) -> &mut Self {
        self.put(&(value as f32).to_le_bytes())
    }

    /// Appends an `int32_t`.
    pub fn i32(&mut self, value: i32) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// Appends a `uint8_t`.
    pub fn u8(&mut self, value: u8) -> &mut Self {
        self.put(&[value])
    }

    /// Appends a `bool`.
    pub fn bool(&mut self, value: bool) -> &mut Self {
        self.put(&[u8::from(value)])
    }

    /// Appends a `float[N]`.
    pub fn floats(&mut self, values: &[f64]) -> &mut Self {
        for value in values {
            self.f32(*value);
        }
        self
    }

    /// Appends a `float[3]`, or three `float` fields.
    pub fn vec<F>(&mut self, vector: Vec3<F>) -> &mut Self {
        self.floats(&vector.array())
    }

    /// Appends a `float[4]` quaternion: w, x, y, z.
    pub fn quaternion<A, B>(&mut self, rotation: Rotation<A, B>) -> &mut Self {
        self.floats(&rotation.wxyz())
    }

    /// Returns the encoded row.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn put(&mut self, bytes: &[u8]) -> &mut Self {
        self.bytes.extend_from_slice(bytes);
        self
    }
}
