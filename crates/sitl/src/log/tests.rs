use super::*;

#[test]
fn exact_topics_and_field_names_are_unique() {
    for (k, topic) in TOPICS.iter().enumerate() {
        assert!(TOPICS[..k].iter().all(|other| other.name != topic.name), "duplicate {}", topic.name);
        assert!(topic.fields.ends_with(';') && topic.rate_hz > 0.0);
        let names: Vec<&str> = topic.fields.split_terminator(';').map(|field| field.split_once(' ').unwrap().1).collect();
        assert!(names.iter().enumerate().all(|(k, name)| !names[..k].contains(name)), "{}: {names:?}", topic.name);
    }
}
