//! Messages as ROS 2 sends them: binary, in plain CDR, little endian (OMG DDSI-RTPS 2.5, section 10).

/// Reads values in sequence. Each value is aligned to its own size, counted from the end of the four-byte header. Methods return
/// `None` if the bytes end before the value does.
pub(super) struct Cdr<'a> {
    content: &'a [u8],
    at: usize,
}

impl<'a> Cdr<'a> {
    /// Creates a reader of a message. `None` if its header states another encoding.
    pub fn new(bytes: &'a [u8]) -> Option<Self> {
        let content = bytes.strip_prefix(&[0, 1])?.get(2..)?;
        Some(Self { content, at: 0 })
    }

    fn take<const SIZE: usize>(&mut self) -> Option<[u8; SIZE]> {
        let from = self.at.next_multiple_of(SIZE);
        let value = self.content.get(from..from.checked_add(SIZE)?)?;
        self.at = from + SIZE;
        value.try_into().ok()
    }

    pub fn i32(&mut self) -> Option<i32> {
        self.take().map(i32::from_le_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub fn f64(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    /// Reads a `string`, whose length includes the final zero.
    pub fn string(&mut self) -> Option<String> {
        let length = self.u32()? as usize;
        let bytes = self.content.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        String::from_utf8(bytes.strip_suffix(&[0])?.to_vec()).ok()
    }

    pub fn strings(&mut self) -> Option<Vec<String>> {
        self.sequence(5, Self::string)
    }

    pub fn f64s(&mut self) -> Option<Vec<f64>> {
        self.sequence(8, Self::f64)
    }

    /// Reads a sequence whose elements have at least `least` bytes each. Returns `None` if its length exceeds the
    /// remaining bytes.
    pub fn sequence<T>(&mut self, least: usize, mut element: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let length = self.u32()? as usize;
        if length.checked_mul(least)? > self.content.len() {
            return None;
        }
        (0..length).map(|_| element(self)).collect()
    }

    /// Reads a `Time` or `Duration`: seconds and nanoseconds.
    pub fn nanoseconds(&mut self) -> Option<i64> {
        Some(i64::from(self.i32()?) * 1_000_000_000 + i64::from(self.u32()?))
    }

    /// Reads a `Header`, and returns its stamp in nanoseconds.
    pub fn header(&mut self) -> Option<i64> {
        let stamp = self.nanoseconds()?;
        self.string()?;
        Some(stamp)
    }
}
