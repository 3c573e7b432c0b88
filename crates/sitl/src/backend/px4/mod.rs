//! PX4's simulator interface: MAVLink over TCP in lockstep.
