//! Messages in the bytes that ROS 2 sends.

/// Writes plain CDR, version 1, little endian (OMG Common Object Request Broker Architecture 3.3, part 2, section 9.3;
/// OMG DDSI-RTPS 2.5, section 10): a four-byte header, then each value aligned to its own size, counted from the end of
/// the header. Padding is zero.
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

    /// Writes a sequence of `float64`. An empty one consists of its length, without padding for elements.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the bytes that `write` writes after the header.
    fn content(write: impl FnOnce(&mut Cdr)) -> Vec<u8> {
        let mut cdr = Cdr::new();
        write(&mut cdr);
        let bytes = cdr.into_bytes();
        assert_eq!(bytes[..4], [0x00, 0x01, 0x00, 0x00]);
        bytes[4..].to_vec()
    }

    #[test]
    fn numbers_are_little_endian() {
        assert_eq!(content(|c| c.u32(0x1234_5678)), [0x78, 0x56, 0x34, 0x12]);
        assert_eq!(content(|c| c.i32(-2)), [0xfe, 0xff, 0xff, 0xff]);
        // -1.5 is binary -1.1: sign 1, exponent 0x3ff, mantissa 0x8000000000000.
        assert_eq!(content(|c| c.f64(-1.5)), [0, 0, 0, 0, 0, 0, 0xf8, 0xbf]);
    }

    #[test]
    fn strings_end_in_a_zero_that_counts() {
        assert_eq!(content(|c| c.string("")), [1, 0, 0, 0, 0]);
        assert_eq!(content(|c| c.string("né")), [4, 0, 0, 0, b'n', 0xc3, 0xa9, 0]);
    }

    #[test]
    fn values_lie_at_multiples_of_their_size_after_the_header() {
        // 5 bytes of string, 3 of filling, 4 of length, 4 of filling, 8 of value.
        let bytes = content(|c| {
            c.string("");
            c.f64s(&[2.0]);
        });
        assert_eq!(bytes, [1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40]);
        // The header itself does not count: a first double follows it at once, one after a word leaves four bytes free.
        assert_eq!(content(|c| c.f64(2.0)).len(), 8);
        let bytes = content(|c| {
            c.u32(7);
            c.f64(2.0);
        });
        assert_eq!(bytes, [7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40]);
    }

    #[test]
    fn empty_sequences_are_a_length() {
        let bytes = content(|c| {
            c.f64s(&[]);
            c.u32(9);
        });
        assert_eq!(bytes, [0, 0, 0, 0, 9, 0, 0, 0]);
        let names = ["a".to_owned(), "bc".to_owned()];
        let bytes = content(|c| c.strings(&names));
        assert_eq!(bytes, [2, 0, 0, 0, 2, 0, 0, 0, b'a', 0, 0, 0, 3, 0, 0, 0, b'b', b'c', 0]);
    }
}
