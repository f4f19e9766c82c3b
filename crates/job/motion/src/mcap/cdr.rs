//! Messages in the binary form of ROS 2.

/// Writes plain CDR, version 1, little endian (OMG Common Object Request Broker Architecture 3.3, part 2, section 9.3; OMG
/// DDSI-RTPS 2.5, section 10): a four-byte header, then values, each aligned to its own size, counted from the end of the header.
/// Padding is zero.
#[derive(Debug, Clone)]
pub struct Cdr {
    bytes: Vec<u8>,
}

/// Identifier of the encoding: plain CDR, little endian; no options (DDSI-RTPS).
const HEADER: [u8; 4] = [0, 1, 0, 0];

impl Cdr {
    /// Starts an empty message.
    pub fn new() -> Self {
        Self { bytes: HEADER.to_vec() }
    }

    /// Returns the message's bytes with the header.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// Writes a `uint8`, or a `bool` as one.
    pub fn u8(&mut self, value: u8) {
        self.put([value]);
    }

    /// Writes an `int32`, aligned to four bytes.
    pub fn i32(&mut self, value: i32) {
        self.put(value.to_le_bytes());
    }

    /// Writes a `uint32`, aligned to four bytes.
    pub fn u32(&mut self, value: u32) {
        self.put(value.to_le_bytes());
    }

    /// Writes a `float32`, aligned to four bytes.
    pub fn f32(&mut self, value: f32) {
        self.put(value.to_le_bytes());
    }

    /// Writes a `float64`, aligned to its size.
    pub fn f64(&mut self, value: f64) {
        self.put(value.to_le_bytes());
    }

    /// Writes the length of a sequence. Its elements must follow.
    pub fn length(&mut self, length: usize) {
        self.u32(u32::try_from(length).expect("fewer than 2^32 elements"));
    }

    /// Writes a `string`: its length in bytes including a final zero, then the bytes and the zero.
    pub fn string(&mut self, value: &str) {
        self.length(value.len() + 1);
        self.bytes.extend_from_slice(value.as_bytes());
        self.bytes.push(0);
    }

    /// Writes a sequence of `string`.
    pub fn strings(&mut self, values: &[String]) {
        self.length(values.len());
        values.iter().for_each(|value| self.string(value));
    }

    /// Writes a sequence of `float64`. If it is empty, writes its length without padding for elements.
    pub fn f64s(&mut self, values: &[f64]) {
        self.length(values.len());
        values.iter().for_each(|value| self.f64(*value));
    }

    fn put<const SIZE: usize>(&mut self, value: [u8; SIZE]) {
        let content = self.bytes.len() - HEADER.len();
        self.bytes.resize(HEADER.len() + content.next_multiple_of(SIZE), 0);
        self.bytes.extend_from_slice(&value);
    }
}
