//! One simulation step, in a written order (design.md, "One simulation step").
