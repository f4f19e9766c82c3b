//! Types that stand for fields of world files in the JSON schema.

pub(super) use cplan_robot::schema::*;
use cplan_robot::stands_for;

stands_for! {
    /// A number of 0 or more.
    NotNegative, { "type": "number", "minimum": 0 }
}
stands_for! {
    /// A number above 0 and at most 1.
    Share, { "type": "number", "exclusiveMinimum": 0, "maximum": 1 }
}
stands_for! {
    /// Corners of a polygon.
    Corners, {
        "type": "array",
        "minItems": 3,
        "items": { "type": "array", "items": { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd) *$" }, "minItems": 2, "maxItems": 2 }
    }
}
stands_for! {
    /// Corners of a polygon, or of an outer ring and its holes.
    Rings, {
        "type": "array",
        "anyOf": [
            {
                "minItems": 3,
                "items": { "type": "array", "items": { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd) *$" }, "minItems": 2, "maxItems": 2 }
            },
            {
                "minItems": 1,
                "items": {
                    "type": "array",
                    "minItems": 3,
                    "items": { "type": "array", "items": { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd) *$" }, "minItems": 2, "maxItems": 2 }
                }
            }
        ]
    }
}
stands_for! {
    /// Kind of the unknown cells of an image.
    UnknownAs, { "type": "string", "enum": ["solid", "free"] }
}
stands_for! {
    /// The link to which a sensor is attached.
    SensorOn, { "type": "string", "enum": ["tip", "base"] }
}
stands_for! {
    /// Order of steps.
    DoneIn, { "type": "string", "enum": ["fixed", "free"] }
}
stands_for! {
    /// Side of the elbow.
    ElbowSide, { "type": "string", "enum": ["left", "right"] }
}
