//! Why a picture does not show a defect. The monitor sends and stores these reasons in English.

use crate::sentences::Sentence;
use crate::text;

/// All reasons.
pub const PICTURE_REASONS: [Sentence; 7] = [
    Sentence::new(0, |l, _| text!(l, "terms-picture-not-central")),
    Sentence::new(0, |l, _| text!(l, "terms-picture-hidden")),
    Sentence::new(2, |l, v| text!(l, "terms-picture-too-oblique", value = v[0], limit = v[1])),
    Sentence::new(2, |l, v| text!(l, "terms-picture-too-small", value = v[0], limit = v[1])),
    Sentence::new(2, |l, v| text!(l, "terms-picture-line-too-thin", value = v[0], limit = v[1])),
    Sentence::new(2, |l, v| text!(l, "terms-picture-dark-lamp-on", value = v[0], limit = v[1])),
    Sentence::new(2, |l, v| text!(l, "terms-picture-dark-lamp-off", value = v[0], limit = v[1])),
];
