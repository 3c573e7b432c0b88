//! Tests of names, types, ranges, both encodings, and the checksum.

use super::*;

const REAL: MavParamType = MavParamType::MAV_PARAM_TYPE_REAL32;
const INT: MavParamType = MavParamType::MAV_PARAM_TYPE_INT32;

pub fn of(face: &'static ParamView) -> Params {
    Params::new(1, AircraftValues::SMALL_AIRCRAFT, face)
}

#[test]
fn exact_integers_are_encoded_bytewise_and_invalid_values_change_nothing() {
    let mut params = of(&param_view::PX4);
    let before = params.clone();
    assert_eq!(params.set("MIS_TAKEOFF_ALT", f32::NAN, REAL), Err(ParamRefusal::OutOfRange));
    assert_eq!(params.set("MIS_TAKEOFF_ALT", 1e6, REAL), Err(ParamRefusal::OutOfRange));
    assert_eq!(params.set("NAV_RCL_ACT", 2.0, REAL), Err(ParamRefusal::Type));
    assert_eq!(params.set("NO_SUCH", 2.0, REAL), Err(ParamRefusal::Unknown));
    assert_eq!(params.set("SPAN_FLAVOUR", 0.0, INT), Err(ParamRefusal::ReadOnly));
    assert_eq!(params, before);
    assert_eq!(params.set("NAV_RCL_ACT", Int(2).to_wire(), INT), Ok(()));
    assert_eq!(params.find("NAV_RCL_ACT").map(|p| p.2), Some(Int(2)));
}

#[test]
fn exact_copter_names_read_and_set_the_underlying_parameter_in_their_units() {
    let mut params = of(&param_view::COPTER);
    assert_eq!(params.set("WPNAV_SPEED", 350.0, REAL), Ok(()));
    assert_eq!((params.cruise_m_s(), params.find("WPNAV_SPEED").map(|p| p.2)), (3.5, Some(Real(350.0))));
    assert_eq!(params.set("FS_GCS_ENABLE", 5.0, REAL), Ok(()), "the value must be cast regardless of the declared type");
    assert_eq!(params.whole("NAV_DLL_ACT"), Some(3));
    assert_eq!(params.set("FS_GCS_ENABLE", 4.0, INT), Err(ParamRefusal::OutOfRange), "the vehicle does not support this action");
    assert_eq!(params.set("BATT_LOW_MAH", 1_040.0, REAL), Ok(()));
    assert_eq!(params.number("BAT_LOW_THR") as f32, 0.2);
    assert_eq!(params.set("FRAME_CLASS", 2.0, INT), Err(ParamRefusal::ReadOnly));
    assert_eq!(params.set("MPC_XY_CRUISE", 3.0, REAL), Err(ParamRefusal::Unknown), "the name belongs to another flavor");
    assert_eq!(params.set("RC_OVERRIDE_TIME", f32::NAN, REAL), Err(ParamRefusal::OutOfRange));
    let told = params.outgoing(params.find("FS_GCS_ENABLE").unwrap().0).unwrap();
    assert_eq!((told.wire, told.kind), (5.0, MavParamType::MAV_PARAM_TYPE_INT8));
}

#[test]
fn exact_every_reported_bound_can_be_set_and_read_back() {
    for face in [&param_view::PX4, &param_view::COPTER, &param_view::GENERIC] {
        let mut params = of(face);
        for row in face.rows().iter().filter(|row| !row.read_only && !matches!(row.source, ParamSource::Mapped(..))) {
            let (low, high) = params.range(row.name).unwrap();
            for bound in [low, high] {
                let value = row.default.with_number(bound);
                assert_eq!(params.set_value(row.name, value), Ok(()), "{} = {bound}", row.name);
                let back = params.find(row.name).unwrap().2.number();
                assert!((back - value.number()).abs() <= 1e-6 * bound.abs().max(1.0), "{} = {bound}: {back}", row.name);
            }
        }
    }
}

/// A value whose type differs from its row's type would shift everything after it in the packed file.
#[test]
fn regress_every_value_has_the_type_of_its_row() {
    for face in [&param_view::PX4, &param_view::COPTER, &param_view::GENERIC] {
        let params = of(face);
        for row in face.rows() {
            let value = params.shown(row);
            assert_eq!(std::mem::discriminant(&value), std::mem::discriminant(&row.default), "{}: {value:?}", row.name);
        }
    }
}

/// Computes the checksum bit by bit: with polynomial 0xEDB88320, a register that starts at zero, and no inversion.
#[test]
fn exact_checksum_uses_the_plain_polynomial_and_depends_on_every_value() {
    let mut params = of(&param_view::PX4);
    let mut register = 0u32;
    for row in table::rows().iter().filter(|row| !row.volatile) {
        let value = params.values[row.name];
        for byte in row.name.bytes().chain(value.to_wire().to_bits().to_le_bytes()) {
            register ^= u32::from(byte);
            for _ in 0..8 {
                register = register >> 1 ^ if register & 1 == 1 { 0xEDB8_8320 } else { 0 };
            }
        }
    }
    assert_eq!(params.hash(), register);
    params.set("MIS_TAKEOFF_ALT", 3.0, REAL).unwrap();
    assert_ne!(params.hash(), register);
}
