"""Does the lesson `first-flight` with a device for the hands: its sticks are either at rest or pushed, in steps as its texts say."""

import math

import asking
import handpilot
from stick_client import M
from test_lesson import ABOVE_PAD, DEFECT, PIER, RING, SQUARE, lesson_texts

# Distance that a pushed stick moves the drone per second, m: along the ground and up, with the time in which the drone gains speed and stops. Too
# large a value only takes more steps.
GROUND_M_S, CLIMB_M_S = 5.0, 2.0
# Rate at which a pushed stick turns the drone, rad/s, as for the distances.
TURN_RAD_S = 0.6
# Time after which a turn or a tilt has ended, vehicle milliseconds.
SETTLE_MS = 1500
# Heading and camera pitch that are good enough, rad: 4 and 6 degrees, of which a path of 12 m misses its end by 1 m, and the defect stays
# between the corner marks.
TURNED_RAD, TILTED_RAD = 0.07, 0.1
# Pitch that the lesson asks for, degrees (scenarios/first-flight.toml).
TILT_DEG = 20.0
# Shortest and longest time for which a stick is pushed in one step, vehicle milliseconds.
HOLD_MS = (120, 2000)
# Distance from the middle of the ring that is good enough on each axis, m (the radius is 2 m), and speed of a drone that stands, m/s.
NEAR_M, STANDING_M_S = 0.8, 0.15
# Radius of the ring, m (scenarios/first-flight.toml), and time in it after which it is left, vehicle milliseconds. From 2 s, leaving is a mistake, and
# from 10 s, the step is done.
RING_RADIUS_M, INSIDE_MS = 2.0, 2500


class LessonPilot:
    """Flies with a device, and reads position and texts over a link of its own, on which it sends nothing else.

    The device has two methods: `hold` pushes the sticks in a set of directions and releases the others, and `tap` calls an action
    by its name in the profiles of controllers. An action without an effect is repeated after `again_s`.
    """

    def __init__(self, device, client, again_s):
        self.device, self.client, self.again_s = device, client, again_s

    def said(self, words):
        """Returns whether a text of the lesson contained the words."""
        return any(words in text for text in lesson_texts(self.client))

    def wait_for_text(self, words):
        """Waits for a text of the lesson."""
        self.client.wait(words, lambda: self.said(words))

    def now_ms(self):
        """Returns the vehicle's time."""
        return self.client.state["ATTITUDE"].time_boot_ms

    def wait_ms(self, duration_ms):
        """Lets vehicle time pass."""
        until = self.now_ms() + duration_ms
        self.client.wait(f"{duration_ms} ms", lambda: self.now_ms() >= until)

    def stand(self):
        """Releases the sticks and waits until the drone stands."""
        self.device.hold(set())
        self.wait_ms(500)
        moving = lambda: self.client.state["LOCAL_POSITION_NED"]  # noqa: E731
        self.client.wait("a standstill", lambda: math.hypot(moving().vx, moving().vy, moving().vz) < STANDING_M_S)

    def step_towards(self, target):
        """Pushes the stick of the axis that is farthest off for a moment. Returns false if the drone is near the target."""
        here, yaw = self.client.here()
        east, north, up = (t - h for t, h in zip(target, here))
        cos, sin = math.cos(yaw), math.sin(yaw)
        ways = [
            (north * cos + east * sin, GROUND_M_S, "forward", "back"),
            (east * cos - north * sin, GROUND_M_S, "right", "left"),
            (up, CLIMB_M_S, "up", "down"),
        ]
        way, speed, plus, minus = max(ways, key=lambda axis: abs(axis[0]))
        if abs(way) <= NEAR_M:
            return False
        self.device.hold({plus if way > 0 else minus})
        self.wait_ms(min(max(1000 * abs(way) / speed, HOLD_MS[0]), HOLD_MS[1]))
        return True

    def fly(self, target, done=lambda: False):
        """Flies to a place in steps, each to a standstill, unless `done` returns true before."""
        self.stand()
        while not done() and self.step_towards(target):
            self.stand()

    def is_in_ring_for(self, duration_ms):
        """Returns a function for `fly` that is true as soon as the drone has been in the ring for a time."""
        entered_ms = []

        def is_over():
            here, _ = self.client.here()
            if handpilot.distance(here, RING) > RING_RADIUS_M:
                entered_ms.clear()
            elif not entered_ms:
                entered_ms.append(self.now_ms())
            return bool(entered_ms) and self.now_ms() >= entered_ms[0] + duration_ms

        return is_over

    def turn(self, yaw):
        """Turns to a heading, rad."""
        while abs(error := handpilot.wrap_angle(yaw - self.client.here()[1])) > TURNED_RAD:
            self.device.hold({"clockwise" if error > 0 else "counterclockwise"})
            self.wait_ms(min(max(1000 * abs(error) / TURN_RAD_S, HOLD_MS[0]), HOLD_MS[1]))
            self.device.hold(set())
            self.wait_ms(SETTLE_MS)

    def tilt(self, pitch):
        """Tilts the camera to a pitch, rad, up positive. Each action tilts it by a step."""
        while abs(error := pitch - self.camera_pitch()) > TILTED_RAD:
            self.device.tap("gimbal_up" if error > 0 else "gimbal_down")
            self.wait_ms(SETTLE_MS)

    def camera_pitch(self):
        """Returns the pitch of the camera, rad, up positive."""
        w, x, y, z = self.client.state["GIMBAL_DEVICE_ATTITUDE_STATUS"].q
        return math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))

    def tap_until_text(self, words, *actions):
        """Calls actions, and again if nothing happens, until a text of the lesson contains the words."""
        again = asking.Repeater(lambda: [self.device.tap(action) for action in actions], again_s=self.again_s)
        self.client.wait(words, lambda: again.if_due() or self.said(words))


def do_the_first_steps(pilot, mistake_seen=lambda: None):
    """Does the steps up to the turn. Motors stopped too early and a ring left too early are remarked; calls `mistake_seen` after that."""
    client = pilot.client
    client.wait("position", lambda: {"LOCAL_POSITION_NED", "ATTITUDE", "GPS_GLOBAL_ORIGIN"} <= client.state.keys() or client.ask_origin())
    pilot.tap_until_text("2/11 take off to 2 m", "arm")
    pilot.tap_until_text("the motors are off: arm them again", "disarm")
    assert not pilot.said("3/11"), "without a takeoff, the lesson waits"
    pilot.tap_until_text("3/11 hover in the ring for 10 s", "arm", "take_off")
    assert client.state["HEARTBEAT"].base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED

    # A busy machine makes the last steps to the middle slow, so the time counts from the edge of the ring.
    is_inside = pilot.is_in_ring_for(INSIDE_MS)
    pilot.fly(RING, done=is_inside)
    client.wait("time in the ring", is_inside)
    assert not pilot.said("4/11"), "10 s are not over"
    pilot.device.hold({"forward"})
    pilot.wait_for_text("you left the ring: stay 10 s")
    pilot.stand()
    mistake_seen()
    assert not pilot.said("4/11")
    pilot.fly(RING)
    pilot.wait_for_text("4/11 turn by 90 deg")
    pilot.device.hold({"clockwise"})
    pilot.wait_for_text("5/11 fly along the path")
    pilot.device.hold(set())


def do_the_other_steps(pilot, defect_seen=lambda: None):
    """Does the steps from the path to the landing. A picture without a defect is remarked. Calls `defect_seen` before the picture of the defect."""
    pilot.turn(0.0)
    for corner in SQUARE:
        pilot.fly(corner, done=lambda: pilot.said("6/11"))
    pilot.wait_for_text("6/11 stop in the ring for 3 s")
    pilot.fly(PIER)
    pilot.wait_for_text("7/11 tilt the camera up 20 deg")
    pilot.tilt(math.radians(TILT_DEG))
    pilot.wait_for_text("8/11 turn the lamp on")
    pilot.tap_until_text("9/11 photograph a defect", "lamp")
    pilot.turn(-math.pi / 2)
    pilot.tap_until_text("no defect in the picture", "snapshot")
    assert not pilot.said("10/11"), "a picture without a defect is not enough"
    here, _ = pilot.client.here()
    heading, elevation = handpilot.aim(here, DEFECT)
    pilot.turn(heading)
    pilot.tilt(elevation)
    defect_seen()
    pilot.tap_until_text("10/11 fly back to the pad", "snapshot")
    pilot.fly(ABOVE_PAD, done=lambda: pilot.said("11/11"))
    pilot.wait_for_text("11/11 land on the pad")
    pilot.fly(ABOVE_PAD)
    pilot.tap_until_text("all steps done", "land")
