"""The mission protocol step by step over UDP with pymavlink: partial plans, a canceled upload, a second station in
between."""

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

import spandrel
from spandrel import wait_for

# Time limit for responses, wall seconds. Responses usually arrive within milliseconds; the limit only prevents a broken
# run from hanging.
LIMIT_S = 30
LAT, LON = 467_052_000, 83_814_000


class Station:
    """A ground station that uses the mission protocol one message at a time."""

    def __init__(self, port, system):
        self.link = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}", dialect="common", source_system=system)
        wait_for("the vehicle", self.exchange_heartbeats, limit_s=LIMIT_S)

    def exchange_heartbeats(self):
        """Sends a heartbeat; returns whether the vehicle has sent one."""
        self.link.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE)
        return self.link.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2)

    def receive(self, *kinds):
        """Returns the next message of these kinds for this station."""
        for _ in range(10_000):
            message = self.link.recv_match(type=list(kinds), blocking=True, timeout=LIMIT_S)
            assert message is not None, kinds
            if message.target_system == self.link.source_system:
                return message
        raise AssertionError(kinds)

    def count(self, items):
        """Starts an upload."""
        self.link.mav.mission_count_send(1, 1, items)

    def item(self, seq, height):
        """Sends one waypoint."""
        self.link.mav.mission_item_int_send(1, 1, seq, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, mavlink.MAV_CMD_NAV_WAYPOINT, 0, 1,
                                            0, 0, 0, float("nan"), LAT, LON, height)

    def answer(self, until_seq, height):
        """Answers requests until an item number is requested or an acknowledgment arrives. Returns the acknowledgment's
        result."""
        while True:
            heard = self.receive("MISSION_REQUEST_INT", "MISSION_ACK")
            if heard.get_type() == "MISSION_ACK":
                return heard.type
            if heard.seq == until_seq:
                return None
            self.item(heard.seq, height)

    def plan_heights(self):
        """Returns the heights in the vehicle's current plan."""
        self.link.mav.mission_request_list_send(1, 1)
        found = []
        for seq in range(self.receive("MISSION_COUNT").count):
            self.link.mav.mission_request_int_send(1, 1, seq)
            item = self.receive("MISSION_ITEM_INT")
            assert item.seq == seq
            found.append(item.z)
        self.link.mav.mission_ack_send(1, 1, mavlink.MAV_MISSION_ACCEPTED)
        return found


@pytest.mark.timeout(300)
def test_wire_mission_protocol_handles_partial_canceled_and_concurrent_transfers(tmp_path):
    """Incomplete transfers must have no effect. The transfer that starts first must end first."""
    unused, port = spandrel.free_udp_port(), spandrel.free_udp_port()
    process = spandrel.start_sim(tmp_path, unused, speed=1, gcs_port=port)
    try:
        one, two = Station(port, 250), Station(port, 251)
        one.count(6)
        assert one.answer(None, 5.0) == mavlink.MAV_MISSION_ACCEPTED
        one.link.mav.mission_write_partial_list_send(1, 1, 2, 3)
        assert one.answer(None, 9.0) == mavlink.MAV_MISSION_ACCEPTED
        assert two.plan_heights() == [5.0, 5.0, 9.0, 9.0, 5.0, 5.0]
        # Canceled in the middle: the plan must not change.
        one.count(4)
        assert one.answer(2, 7.0) is None
        one.link.mav.mission_ack_send(1, 1, mavlink.MAV_MISSION_OPERATION_CANCELLED)
        assert one.plan_heights() == [5.0, 5.0, 9.0, 9.0, 5.0, 5.0]
        # A second station downloads during the first one's upload, and must not upload.
        one.count(3)
        assert one.answer(1, 8.0) is None
        assert two.plan_heights() == [5.0, 5.0, 9.0, 9.0, 5.0, 5.0]
        two.count(1)
        assert two.answer(None, 1.0) == mavlink.MAV_MISSION_DENIED
        one.item(1, 8.0)
        assert one.answer(None, 8.0) == mavlink.MAV_MISSION_ACCEPTED
        two.count(1)
        assert two.answer(None, 1.0) == mavlink.MAV_MISSION_ACCEPTED
        assert one.plan_heights() == [1.0]
    finally:
        spandrel.end(process)
