"""A small flight controller on a pseudo-terminal, for hardware in the loop. It flies as the small autopilot in fake_px4 does, but has a
clock of its own, runs in real time, and sends motor commands and ordinary MAVLink messages on one serial link. Its behavior is one of:
  fly       takes MANUAL_CONTROL and commands, also the one to reboot
  stubborn  like fly, but refuses to reboot
  quick     like fly, but reboots so quickly that its silence is not noticed
  mute      never sends motor commands
  silent    sends motor commands for a while, then only ordinary messages
"""

import os
import pty
import threading
import time
import tty

import fake_px4
from fake_px4 import mavlink

# The clock's offset from the computer's until it reboots, s.
CLOCK_OFFSET_S = 1234.5
# Rates of the motor commands and of the periodic messages, Hz. PX4 sends motor commands at 200 Hz.
CONTROL_HZ, REPORT_HZ = 200, 5
# Time without frames during a reboot, s, usually and with the behavior "quick".
BOOT_S, QUICK_BOOT_S = 2.0, 0.3


class FlightController(fake_px4.Autopilot):
    """The flight controller and its end of the serial link."""

    def __init__(self, behavior="fly", system_id=1):
        self.link, self.device = pty.openpty()
        for end in (self.link, self.device):
            tty.setraw(end)
        os.set_blocking(self.link, False)
        self.path = os.ttyname(self.device)
        self.mav = mavlink.MAVLink(None, srcSystem=system_id, srcComponent=1)
        self.mav.robust_parsing = True
        self.behavior, self.first_reading, self.last_reading = behavior, None, None
        self.readings, self.armed, self.throttle, self.version = 0, False, 0.0, fake_px4.VERSION
        self.sensor, self.reboots, self.commands, self.kinds = None, 0, 0, {}
        self.clock_start_ns = -int(CLOCK_OFFSET_S * 1e9)
        self.ends, self.power_cycle = threading.Event(), threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def say(self, message):
        """Sends a message on the serial link. If its buffer is full, the message is lost."""
        try:
            os.write(self.link, message.pack(self.mav))
        except OSError:
            pass

    def rate_hz(self):
        """Returns the mean rate of the readings."""
        return (self.readings - 1) / (self.last_reading - self.first_reading)

    def _clock_ns(self):
        return time.monotonic_ns() - self.clock_start_ns

    def _run(self):
        start, controls, reports = time.monotonic(), 0, 0
        while not self.ends.wait(0.5 / CONTROL_HZ):
            if self.power_cycle.is_set():
                self.power_cycle.clear()
                self._restart()
            self._receive()
            elapsed = time.monotonic() - start
            if elapsed * REPORT_HZ >= reports:
                reports = int(elapsed * REPORT_HZ) + 1
                self.report()
            if elapsed * CONTROL_HZ >= controls:
                controls = int(elapsed * CONTROL_HZ) + 1
                self._control()

    def _receive(self):
        try:
            data = os.read(self.link, 65536)
        except OSError:
            return
        for message in self.mav.parse_buffer(data) or []:
            kind = message.get_type()
            self.kinds[kind] = self.kinds.get(kind, 0) + 1
            if kind == "HIL_SENSOR":
                self.sensor, self.readings, self.last_reading = message, self.readings + 1, time.monotonic()
                self.first_reading = self.first_reading or self.last_reading
            elif kind == "TIMESYNC" and message.tc1 == 0:
                self.say(mavlink.MAVLink_timesync_message(self._clock_ns(), message.ts1))
            elif kind == "COMMAND_LONG" and message.command == mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN:
                self._reboot(message)
            else:
                self.handle(message)

    def _reboot(self, message):
        accepted = self.behavior != "stubborn"
        result = mavlink.MAV_RESULT_ACCEPTED if accepted else mavlink.MAV_RESULT_DENIED
        self.say(mavlink.MAVLink_command_ack_message(message.command, result, 0, 0, message.get_srcSystem(), message.get_srcComponent()))
        if accepted:
            self._restart()

    def _restart(self):
        """Sends nothing for the time of a boot, and starts anew."""
        self.clock_start_ns = time.monotonic_ns()
        self.ends.wait(QUICK_BOOT_S if self.behavior == "quick" else BOOT_S)
        self.readings, self.first_reading, self.armed, self.sensor = 0, None, False, None
        self.reboots += 1

    def _control(self):
        is_silent = self.behavior == "silent" and self.readings > 2 * fake_px4.READY
        if self.sensor is None or self.behavior == "mute" or is_silent:
            return
        self.commands += 1
        # A flight controller's time stamps are its own, and it does not set the lockstep flag.
        answer = self.controls(self.sensor)
        self.say(mavlink.MAVLink_hil_actuator_controls_message(self._clock_ns() // 1000, answer, self.mode(), 0))

    def unplug(self):
        """Ends the flight controller and disconnects the serial port."""
        if not self.ends.is_set():
            self.ends.set()
            self.thread.join()
            os.close(self.device)
            os.close(self.link)
