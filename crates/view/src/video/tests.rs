use super::*;
use crate::picture::Picture;
use spandrel_model::time::SimTime;

/// Returns a picture of a square that moves across a gray background.
fn picture(k: u32) -> Picture {
    let (width, height) = (320, 180);
    let inside = |x: u32, y: u32| (8 * k..8 * k + 40).contains(&x) && (60..100).contains(&y);
    let pixel = |x, y| if inside(x, y) { [220, 60, 40, 255] } else { [120, 125, 130, 255] };
    Picture { width, height, rgba: (0..height).flat_map(|y| (0..width).flat_map(move |x| pixel(x, y))).collect() }
}

fn encoded(count: u32) -> Vec<EncodedPicture> {
    let mut encoder = H264Encoder::new((320, 180), 15.0, 500_000, 10).unwrap();
    (0..count).map(|k| encoder.encode(&picture(k)).unwrap()).collect()
}

#[test]
fn val_decoded_pictures_match_the_encoded_ones() {
    use openh264::formats::YUVSource;
    let mut decoder = openh264::decoder::Decoder::new().unwrap();
    let mut seen = 0;
    for (k, one) in (0..20).zip(encoded(20)) {
        let stream: Vec<u8> = one.units.iter().flat_map(|unit| [&[0, 0, 0, 1], unit.as_slice()].concat()).collect();
        let Some(image) = decoder.decode(&stream).unwrap() else { continue };
        let mut rgb = vec![0; 3 * 320 * 180];
        assert_eq!(image.dimensions(), (320, 180));
        image.write_rgb8(&mut rgb);
        let red = |x: usize| rgb[3 * (80 * 320 + x)];
        // At half a megabit per second, edges are blurred but centers are not.
        assert!(red(8 * k + 20) > 180 && red(8 * k + 80) < 160, "picture {k}");
        seen += 1;
    }
    assert_eq!(seen, 20);
}

#[test]
fn exact_every_tenth_frame_is_a_keyframe() {
    let keys: Vec<usize> = encoded(25).iter().enumerate().filter(|(_, one)| one.key).map(|(k, _)| k).collect();
    assert_eq!(keys, [0, 10, 20]);
    assert!(H264Encoder::new((321, 180), 15.0, 500_000, 10).is_err(), "odd sizes must be rejected");
}

#[test]
fn exact_reassembled_packets_equal_the_nal_units() {
    let units = vec![vec![0x67, 1, 2], vec![0x65; 5_000], vec![0x41; 1_388], vec![0x41; 1_389]];
    let mut packets = rtp::RtpPacketizer::new(9);
    let number = |packet: &[u8]| u16::from_be_bytes([packet[2], packet[3]]);
    let stamp = |packet: &[u8]| u32::from_be_bytes([packet[4], packet[5], packet[6], packet[7]]);
    let begin = packets.picture(&[vec![0x41, 1]], 0.0).remove(0);
    let sent = packets.picture(&units, 2.0);
    let mut whole: Vec<Vec<u8>> = Vec::new();
    for (k, packet) in sent.iter().enumerate() {
        assert!(packet.len() <= 1_400);
        assert_eq!((packet[0], packet[1] & 0x7F, packet[1] >> 7 == 1), (0x80, 96, k + 1 == sent.len()));
        assert_eq!(number(packet).wrapping_sub(number(&begin)) as usize, k + 1);
        assert_eq!(stamp(packet).wrapping_sub(stamp(&begin)), 180_000);
        assert_eq!(packet[8..12], begin[8..12], "all packets must have the same source");
        let payload = &packet[12..];
        if payload[0] & 0x1F == 28 {
            if payload[1] & 0x80 != 0 {
                whole.push(vec![payload[0] & 0xE0 | payload[1] & 0x1F]);
            }
            whole.last_mut().unwrap().extend(&payload[2..]);
        } else {
            whole.push(payload.to_vec());
        }
    }
    assert_eq!(whole, units);
}

#[test]
fn exact_streams_have_distinct_identifiers() {
    let first = |seed: u64| rtp::RtpPacketizer::new(seed).picture(&[vec![0x41, 1]], 0.0).remove(0);
    assert_eq!(first(1), first(1));
    for field in [2..4, 4..8, 8..12] {
        assert_ne!(first(1)[field.clone()], first(2)[field]);
    }
}

#[test]
fn exact_mp4_file_contains_all_pictures_and_timestamps() {
    let pictures = encoded(30);
    let (mut file, head) = Mp4Writer::new((320, 180), 15.0).unwrap();
    let mut bytes = Vec::new();
    let mut write = |piece: mp4::Mp4Chunk| {
        let end = piece.at as usize + piece.bytes.len();
        bytes.resize(bytes.len().max(end), 0);
        bytes[piece.at as usize..end].copy_from_slice(&piece.bytes);
    };
    write(head);
    pictures.iter().for_each(|one| write(file.push(one).unwrap()));
    file.finish().unwrap().into_iter().for_each(write);
    use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};
    let mut demuxer = Mp4FileDemuxer::new();
    demuxer.handle_input(Input { position: 0, data: &bytes });
    let track = demuxer.tracks().unwrap()[0].clone();
    assert!((track.duration as f64 / f64::from(track.timescale.get()) - 2.0).abs() < 1e-3, "30 pictures at 15 Hz must last 2 s");
    let mut count = 0;
    while let Some(sample) = demuxer.next_sample().unwrap() {
        assert_eq!(sample.keyframe, pictures[count].key);
        count += 1;
    }
    assert_eq!(count, 30);
}

#[test]
fn exact_chapter_titles_are_escaped_single_lines() {
    let chapter = webvtt::Chapter { from_s: 3725.5, to_s: 3727.25, title: "Picture 3: <crack>\nfound".into() };
    assert_eq!(webvtt::write(&[chapter]), "WEBVTT\n\n1\n01:02:05.500 --> 01:02:07.250\nPicture 3: &lt;crack&gt; found\n");
}

#[test]
fn exact_picture_rate_requires_two_pictures_and_averages_two_seconds() {
    let mut rate = PictureRate::default();
    let mut after = |ms: i64| {
        rate.count(SimTime::from_ms(ms));
        rate.hz()
    };
    // A first picture long after the stream was opened must not lower the rate.
    assert_eq!(after(60_000), None);
    assert_eq!(after(60_040), Some(25.0));
    assert_eq!(after(60_500), Some(4.0));
    assert_eq!(after(62_500), Some(0.5), "pictures older than two seconds must not count");
    let steady = (1..=80).map(|k| after(62_500 + 50 * k)).fold(None, |_, hz| hz);
    assert_eq!(steady, Some(20.0));
    assert_eq!(after(600_000).map(f64::round), Some(0.0), "the rate must be zero after a long pause");
}
