fn at(place: u32) -> f32 { return values[place]; }
