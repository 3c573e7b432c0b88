"""Camera, gimbal and lamp with MAVSDK's plugins and with superseded messages, which pymavlink users still send. A
second station receives the changes."""

import math
import os
import time

os.environ["MAVLINK20"] = "1"

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError, RelayCommand
from mavsdk.plugins.camera import Camera, CameraError, Mode, Option, PhotosRange, Setting
from mavsdk.plugins.gimbal import ControlMode, Gimbal, GimbalError, GimbalMode, SendMode
from mavsdk.plugins.telemetry import Telemetry
from pymavlink import mavutil

import asking
import spandrel
from spandrel import wait_for

M = mavutil.mavlink
CAMERA, AUTOPILOT = 100, 1
NAN = float("nan")
# Maximum gimbal angle error, deg; field of view and zoom are transmitted as floats.
NEAR_DEG = 1.0
# Size of a photo and one second of video with the default settings, MiB.
PICTURE_MIB, VIDEO_MIB_S = 6.0, 60e6 / 8 / 2**20
# The zoom range of vehicle-params/m30.toml.
WIDE_DEG, ZOOM_MAX = 84.0, 3.1


class Station:
    """A second ground station, based on pymavlink, that receives everything and uses superseded requests."""

    def __init__(self, port):
        self.link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=254, source_component=190, dialect="all")
        self.heard = []
        self.last = {}

    def pump(self):
        """Processes all messages that have arrived."""
        while (message := self.link.recv_match(blocking=False)) is not None:
            self.heard.append(message)
            self.last[message.get_type(), message.get_srcComponent()] = message

    def wait(self, what, predicate):
        """Processes messages until the predicate is true."""

        def step():
            self.pump()
            return predicate()

        return wait_for(what, step)

    def command(self, component, number, *params):
        """Sends a command and returns the result of its acknowledgment."""
        params = list(params) + [0] * (7 - len(params))
        self.pump()
        self.heard.clear()
        again = asking.Repeater(lambda: self.link.mav.command_long_send(1, component, number, 0, *params))

        def answer():
            for message in self.heard:
                if message.get_type() == "COMMAND_ACK" and message.command == number and message.target_system == 254:
                    return message
            again.if_due()
            return None

        return self.wait(f"acknowledgment of {number}", answer).result

    def ask(self, component, kind, number, *params):
        """Repeats a command until it is accepted and the requested message has arrived."""
        for _ in range(asking.TIMES):
            assert self.command(component, number, *params) == M.MAV_RESULT_ACCEPTED, kind
            end = time.monotonic() + asking.AGAIN_S
            while time.monotonic() < end:
                self.pump()
                if (message := self.last_message(kind)) is not None:
                    return message
        raise AssertionError(f"no {kind}")

    def last_message(self, kind, component=CAMERA):
        """Returns the last message of a kind since the last command."""
        found = [m for m in self.heard if m.get_type() == kind and m.get_srcComponent() == component]
        return found[-1] if found else None


class Rig:
    """MAVSDK's plugins for a vehicle with a zoom lens, and a second station."""

    def __init__(self, folder, *more):
        port, second = spandrel.free_udp_port(), spandrel.free_udp_port()
        self.station = Station(second)
        self.process = spandrel.start_sim(folder, port, "--vehicle", "m30", "--gcs", f"127.0.0.1:{second}", *more)
        self.mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        self.mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = self.mavsdk.first_autopilot(60.0)
        assert system is not None, "no vehicle discovered"
        self.action, self.telemetry = Action(system), Telemetry(system)
        self.camera, self.gimbal = Camera(system), Gimbal(system)
        self.station.wait("heartbeat", lambda: ("HEARTBEAT", CAMERA) in self.station.last)

    def close(self):
        """Stops the vehicle, then MAVSDK, which must be released after the objects that it created."""
        spandrel.end(self.process)
        for plugin in ("action", "telemetry", "camera", "gimbal"):
            getattr(self, plugin).destroy()
            delattr(self, plugin)


@pytest.fixture
def rig(tmp_path):
    """A simulated vehicle and its two stations."""
    rig = Rig(tmp_path)
    yield rig
    rig.close()


def found(rig):
    """Returns the camera's component ID once MAVSDK has found it."""
    cameras = wait_for("camera", lambda: rig.camera.camera_list().cameras)
    assert [(c.component_id, c.vendor_name) for c in cameras] == [(CAMERA, "Spandrel")]
    assert (cameras[0].horizontal_resolution_px, cameras[0].vertical_resolution_px) == (4000, 3000)
    return cameras[0].component_id


def wait_for_camera_status(rig, predicate, what):
    """Waits for storage and capture status, which MAVSDK polls every few seconds."""

    def look():
        try:
            storage = rig.camera.get_storage(CAMERA)
        except CameraError:
            return None
        return storage if predicate(storage) else None

    return wait_for(what, look)


def pictures(rig):
    """Returns the number of photos that the camera reports."""
    return rig.station.ask(CAMERA, "CAMERA_CAPTURE_STATUS", M.MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS, 1).image_count


@pytest.mark.timeout(300)
def test_wire_mavsdk_takes_single_photos_and_series(rig):
    """take_photo, start_photo_interval, capture info with geotags, list_photos, storage, format."""
    camera = found(rig)
    shots = {}
    rig.camera.subscribe_capture_info(lambda info, _: shots.__setitem__(info.index, info))
    wait_for_camera_status(rig, lambda s: s.total_storage_mib > 30_000, "storage")
    for _ in range(2):
        rig.camera.take_photo(camera)
    assert pictures(rig) == 2, "each command must take one photo"
    rig.camera.start_photo_interval(camera, 0.5)
    wait_for_camera_status(rig, lambda s: s.photo_interval_on, "series on")
    wait_for("a series", lambda: max(shots, default=0) >= 5)
    rig.camera.stop_photo_interval(camera)
    wait_for_camera_status(rig, lambda s: not s.photo_interval_on, "series off")
    # MAVSDK requests any photos that it missed before the latest one, but it may also miss the latest one.
    again = asking.Repeater(lambda: rig.camera.take_photo(camera))
    again.if_due()

    def all_reported():
        again.if_due()
        rig.camera.list_photos(camera, PhotosRange.ALL)
        return sorted(shots) == list(range(pictures(rig)))

    wait_for("a message for every photo", all_reported)
    count = len(shots)
    home = rig.telemetry.position()
    for shot in shots.values():
        assert shot.is_success
        assert abs(shot.position.latitude_deg - home.latitude_deg) < 1e-4
        assert abs(shot.position.longitude_deg - home.longitude_deg) < 1e-4
    listed = rig.camera.list_photos(camera, PhotosRange.ALL)
    assert sorted(info.index for info in listed) == list(range(count))
    storage = wait_for_camera_status(rig, lambda s: s.used_storage_mib == count * PICTURE_MIB, "used storage")
    assert math.isclose(storage.used_storage_mib + storage.available_storage_mib, storage.total_storage_mib, abs_tol=0.1)
    rig.camera.format_storage(camera, 1)
    wait_for_camera_status(rig, lambda s: s.used_storage_mib == 0.0, "an empty card")
    rig.camera.take_photo(camera)
    assert pictures(rig) == 1, "numbering must restart"
    again = asking.Repeater(lambda: rig.camera.take_photo(camera))

    def new_photos_listed():
        again.if_due()
        return [info.index for info in rig.camera.list_photos(camera, PhotosRange.ALL)]

    assert max(wait_for("a list of the new photos", new_photos_listed)) < count


@pytest.mark.timeout(300)
def test_wire_mavsdk_records_video_with_its_duration(rig):
    """set_mode, start_video, stop_video, recording time, and the response for a stream that is not running."""
    camera = found(rig)
    with pytest.raises(CameraError):
        rig.camera.start_video(camera)
    again = asking.Repeater(lambda: rig.camera.set_mode(camera, Mode.VIDEO))

    def mode_broadcast():
        again.if_due()
        return getattr(rig.station.last.get(("CAMERA_SETTINGS", CAMERA)), "mode_id", 0) == 1

    rig.station.wait("the mode broadcast", mode_broadcast)
    rig.camera.start_video(camera)
    storage = wait_for_camera_status(rig, lambda s: s.video_on and s.recording_time_s > 3.0, "recording")
    assert storage.recording_time_s < 600.0
    rig.camera.take_photo(camera)
    assert pictures(rig) == 1, "a photo during recording must count"
    with pytest.raises(CameraError):
        rig.camera.set_mode(camera, Mode.PHOTO)
    rig.camera.stop_video(camera)
    storage = wait_for_camera_status(rig, lambda s: not s.video_on, "recording over")
    wait_for_camera_status(rig, lambda s: s.used_storage_mib > PICTURE_MIB + 3.0 * VIDEO_MIB_S, "the recording's share of the card")
    rig.camera.set_mode(camera, Mode.PHOTO)
    wait_for("photo mode again", lambda: rig.camera.get_mode(camera) == Mode.PHOTO)
    stream = wait_for("stream", lambda: (s := rig.camera.get_video_stream_info(camera)).stream_id == 1 and s)
    assert (stream.settings.uri, stream.status) == ("5600", 0)
    with pytest.raises(CameraError):
        rig.camera.start_video_streaming(camera, 1)
    rig.camera.stop_video_streaming(camera, 1)


@pytest.mark.timeout(300)
def test_wire_mavsdk_zoom_changes_are_broadcast(rig):
    """zoom_range, zoom_in_start, zoom_out_start, zoom_stop, focus and reset."""
    camera = found(rig)
    station = rig.station

    def level():
        return getattr(station.last.get(("CAMERA_SETTINGS", CAMERA)), "zoomLevel", NAN)

    def field():
        return getattr(station.last.get(("CAMERA_FOV_STATUS", CAMERA)), "hfov", NAN)

    def seen(level):
        ratio = 1 + level / 100 * (ZOOM_MAX - 1)
        return 2 * math.degrees(math.atan(math.tan(math.radians(WIDE_DEG / 2)) / ratio))

    rig.camera.zoom_range(camera, 40.0)
    station.wait("zoom 40", lambda: abs(level() - 40.0) < 0.01)
    station.wait("field of view at zoom 40", lambda: abs(field() - seen(40.0)) < 0.01)
    rig.camera.zoom_in_start(camera)
    station.wait("telephoto", lambda: level() == 100.0)
    station.wait("a narrow field of view", lambda: abs(field() - seen(100.0)) < 0.01)
    rig.camera.zoom_out_start(camera)
    # The zoom change before the stop depends on the machine's load.
    station.wait("zooming", lambda: level() < 100.0)
    rig.camera.zoom_stop(camera)
    rig.camera.reset_settings(camera)
    station.wait("a wide field of view", lambda: level() == 0.0 and abs(field() - WIDE_DEG) < 0.01)
    rig.camera.focus_auto(camera)
    for by_hand in (rig.camera.focus_in_step, rig.camera.focus_out_start):
        with pytest.raises(CameraError):
            by_hand(camera)


def setting(rig, name):
    """Returns the current option of a setting."""
    return rig.camera.get_setting(CAMERA, Setting(setting_id=name)).option.option_id


def first_setting(rig, name):
    """Like `setting`, but waits until MAVSDK has the value. MAVSDK reads the options in the definition before the
    camera reports any value."""

    def look():
        try:
            return setting(rig, name)
        except CameraError:
            return None

    return wait_for(f"a value of {name}", look)


@pytest.mark.timeout(300)
def test_wire_mavsdk_can_set_every_camera_option(rig):
    """Checks camera settings like the old mavlink-testing-suite: all options in each list, and the ends and middle of
    each range."""
    camera = found(rig)
    ids = ["CAM_PHOTOQUAL", "CAM_VIDRATE"]

    def possible():
        try:
            return {s.setting_id: s for s in rig.camera.get_possible_setting_options(camera)}
        except CameraError:
            return {}

    settings = wait_for("settings", lambda: (s := possible()) and len(s) == len(ids) and s)
    assert sorted(settings) == ids
    for name, options in settings.items():
        initial = first_setting(rig, name)
        wanted = [option.option_id for option in options.options]
        assert options.is_range == (name == "CAM_VIDRATE")
        if options.is_range:
            low, high, step = (int(value) for value in wanted)
            assert high > low and (high - low) % step == 0
            wanted = [str(low), str(high), str(low + (high - low) // 2 // step * step)]
        for value in [*wanted, initial]:
            rig.camera.set_setting(camera, Setting(setting_id=name, option=Option(option_id=value)))
            assert setting(rig, name) == value, name
    with pytest.raises(CameraError):
        rig.camera.set_setting(camera, Setting(setting_id="CAM_PHOTOQUAL", option=Option(option_id="7")))


def pitch_deg(rig, gimbal):
    """Returns the pitch above the horizon."""
    return rig.gimbal.get_attitude(gimbal).euler_angle_forward.pitch_deg


@pytest.mark.timeout(300)
def test_wire_mavsdk_controls_the_gimbal_exclusively(rig):
    """set_angles, set_angular_rates, take_control, release_control, set_roi_location."""
    gimbal = wait_for("gimbal", lambda: rig.gimbal.gimbal_list().gimbals)[0]
    assert (gimbal.gimbal_manager_component_id, gimbal.gimbal_device_id, gimbal.model_name) == (1, 1, "Pitch gimbal")
    own = gimbal.gimbal_id
    for angle, mode, send in [
        (-90.0, GimbalMode.YAW_FOLLOW, SendMode.ONCE),
        (90.0, GimbalMode.YAW_LOCK, SendMode.ONCE),
        (-30.0, GimbalMode.YAW_FOLLOW, SendMode.STREAM),
    ]:
        rig.gimbal.set_angles(own, 0.0, angle, 0.0, mode, send)
        wait_for(f"{angle} degrees", lambda a=angle: abs(pitch_deg(rig, own) - a) < NEAR_DEG)
    for rate, send in [(40.0, SendMode.ONCE), (-40.0, SendMode.STREAM)]:
        rig.gimbal.set_angular_rates(own, 0.0, rate, 0.0, GimbalMode.YAW_FOLLOW, send)
        wait_for(f"the stop at {rate} deg/s", lambda r=rate: abs(pitch_deg(rig, own) - math.copysign(90.0, r)) < NEAR_DEG)
    with pytest.raises(GimbalError):
        rig.gimbal.set_angles(own, 0.0, -120.0, 0.0, GimbalMode.YAW_FOLLOW, SendMode.ONCE)

    rig.gimbal.take_control(own, ControlMode.PRIMARY)
    wait_for("control", lambda: rig.gimbal.get_control_status(own).control_mode == ControlMode.PRIMARY)
    aim = (M.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, 10, NAN, NAN, NAN, 0, 0, 1)
    assert rig.station.command(AUTOPILOT, *aim) == M.MAV_RESULT_DENIED, "only the controlling station may move the gimbal"
    rig.gimbal.set_angles(own, 0.0, -20.0, 0.0, GimbalMode.YAW_FOLLOW, SendMode.ONCE)
    wait_for("gimbal control is still held", lambda: abs(pitch_deg(rig, own) + 20.0) < NEAR_DEG)
    rig.gimbal.release_control(own)
    wait_for("no control", lambda: rig.gimbal.get_control_status(own).control_mode == ControlMode.NONE)
    assert rig.station.command(AUTOPILOT, *aim) == M.MAV_RESULT_ACCEPTED
    wait_for("the aim of the other station", lambda: abs(pitch_deg(rig, own) - 10.0) < NEAR_DEG)

    here = wait_for("position", lambda: (p := rig.telemetry.position()).absolute_altitude_m > 0 and p)
    north = here.latitude_deg + 50.0 / 111_180.0
    rig.gimbal.set_roi_location(own, north, here.longitude_deg, here.absolute_altitude_m + 50.0)

    def at_rest():
        attitude = rig.gimbal.get_attitude(own)
        return abs(attitude.angular_velocity.pitch_rad_s) < 0.05 and attitude.euler_angle_forward.pitch_deg

    # The location is 50 m away and 50 m up, so the angle is 45 degrees; the drone's position is accurate to a meter.
    # Passing the angle on the way elsewhere does not count.
    wait_for("looking up at a location", lambda: abs((at_rest() or 0.0) - 45.0) < 2.5, limit_s=60)


@pytest.mark.timeout(300)
def test_wire_superseded_payload_commands_are_answered(rig):
    """REQUEST_CAMERA_*, DO_DIGICAM_CONTROL, DO_MOUNT_*, relay, servo, actuator: results and the messages that
    follow."""
    station = rig.station
    ok, denied = M.MAV_RESULT_ACCEPTED, M.MAV_RESULT_DENIED
    station.ask(AUTOPILOT, "CAMERA_IMAGE_CAPTURED", M.MAV_CMD_DO_DIGICAM_CONTROL, 0, 0, 0, 0, 1)
    for number, kind in [
        (M.MAV_CMD_REQUEST_CAMERA_INFORMATION, "CAMERA_INFORMATION"),
        (M.MAV_CMD_REQUEST_CAMERA_SETTINGS, "CAMERA_SETTINGS"),
        (M.MAV_CMD_REQUEST_STORAGE_INFORMATION, "STORAGE_INFORMATION"),
        (M.MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS, "CAMERA_CAPTURE_STATUS"),
        (M.MAV_CMD_REQUEST_VIDEO_STREAM_INFORMATION, "VIDEO_STREAM_INFORMATION"),
        (M.MAV_CMD_REQUEST_VIDEO_STREAM_STATUS, "VIDEO_STREAM_STATUS"),
    ]:
        station.ask(CAMERA, kind, number, 1, 1)
    assert station.ask(CAMERA, "CAMERA_IMAGE_CAPTURED", 2002, 0).image_index == 0

    def pitch():
        q = station.last["GIMBAL_DEVICE_ATTITUDE_STATUS", AUTOPILOT].q
        return math.degrees(2 * math.atan2(q[2], q[0]))

    assert station.command(AUTOPILOT, M.MAV_CMD_DO_MOUNT_CONFIGURE, M.MAV_MOUNT_MODE_MAVLINK_TARGETING, 1, 1, 0) == ok
    assert station.command(AUTOPILOT, M.MAV_CMD_DO_MOUNT_CONTROL, -70, 0, 0, 0, 0, 0, M.MAV_MOUNT_MODE_MAVLINK_TARGETING) == ok
    station.wait("mount at -70", lambda: abs(pitch() + 70.0) < NEAR_DEG)
    assert station.command(AUTOPILOT, M.MAV_CMD_DO_MOUNT_CONTROL, 0, 0, 0, 0, 0, 0, M.MAV_MOUNT_MODE_NEUTRAL) == ok
    station.wait("mount neutral", lambda: abs(pitch()) < NEAR_DEG)
    assert station.command(AUTOPILOT, M.MAV_CMD_DO_MOUNT_CONTROL, 0, 0, 0, 0, 0, 0, M.MAV_MOUNT_MODE_RETRACT) == denied

    def lamp():
        relay = station.last.get(("RELAY_STATUS", AUTOPILOT))
        return relay and relay.on & 1

    for on, *command in [
        (1, M.MAV_CMD_DO_SET_RELAY, 0, 1),
        (0, M.MAV_CMD_DO_SET_SERVO, 9, 1100),
        (1, M.MAV_CMD_DO_SET_SERVO, 9, 1900),
        (0, M.MAV_CMD_DO_SET_ACTUATOR, -1, NAN, NAN, NAN, NAN, NAN, 0),
        (1, 405, 1),
        (1, M.MAV_CMD_DO_REPEAT_RELAY, 0, 2, 0.2),
    ]:
        assert station.command(AUTOPILOT, *command) == ok, command
        station.wait(f"lamp {on} by {command}", lambda o=on: lamp() == o)
    assert station.command(AUTOPILOT, M.MAV_CMD_DO_SET_RELAY, 3, 1) == denied


@pytest.mark.timeout(300)
@pytest.mark.parametrize("flavor, output, on, off", [("px4", 1, 1.0, -1.0), ("ardupilot", 9, 1900.0, 1100.0)])
def test_wire_mavsdk_switches_the_lamp_as_a_relay_and_an_actuator(tmp_path, flavor, output, on, off):
    """set_relay and set_actuator, which MAVSDK sends as different commands to an ArduPilot."""
    rig = Rig(tmp_path, "--flavor", flavor)
    try:
        station = rig.station

        def lamp():
            return station.command(AUTOPILOT, M.MAV_CMD_REQUEST_MESSAGE, 376) == M.MAV_RESULT_ACCEPTED and station.last_message("RELAY_STATUS", 1).on

        for switch, wanted in [
            (lambda: rig.action.set_relay(0, RelayCommand.ON), 1),
            (lambda: rig.action.set_actuator(output, off), 0),
            (lambda: rig.action.set_actuator(output, on), 1),
            (lambda: rig.action.set_relay(0, RelayCommand.OFF), 0),
        ]:
            switch()
            wait_for(f"lamp {wanted}", lambda w=wanted: lamp() == w)
        for refused in (lambda: rig.action.set_relay(1, RelayCommand.ON), lambda: rig.action.set_actuator(2, 1.0)):
            with pytest.raises(ActionError):
                refused()
    finally:
        rig.close()
