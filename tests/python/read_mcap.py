"""Reads a recording with the format's own Python packages and compares it with the JSON result of the same run.

    read_mcap.py RESULT.json RESULT.mcap

The messages are decoded by the definitions in the file alone. Positions and velocities of the planned joints must be the same
doubles, times the same nanoseconds; other joints stand still, and there are no accelerations. Exit code 0 if all of it agrees.
"""

import json
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def nanoseconds(time):
    """A Time or Duration message as a number."""
    assert 0 <= time.nanosec < 10**9, time
    return time.sec * 10**9 + time.nanosec


def same(what, found, expected):
    """Ends the program unless both are equal."""
    if found != expected:
        sys.exit(f"{what}: {found} in the recording, {expected} expected")


def main(json_file, mcap_file):
    with open(json_file, encoding="utf-8") as file:
        result = json.load(file)
    trajectory, joints = result["trajectory"], result["joints"]
    times = [round(time * 1e9) for time in trajectory["time"]]

    with open(mcap_file, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        header, summary = reader.get_header(), reader.get_summary()
        messages = {"/joint_states": [], "/joint_trajectory": []}
        for schema, channel, message, content in reader.iter_decoded_messages():
            messages[channel.topic].append((schema.name, message, content))

    # All joints of the robot are named, the planned ones among them.
    names = messages["/joint_trajectory"][0][2].joint_names
    planned = [names.index(joint) for joint in joints]
    others = [k for k in range(len(names)) if k not in planned]
    held = [messages["/joint_states"][0][2].position[k] for k in others]

    def same_rows(what, found, expected, standing):
        same(f"{what} of the planned joints", [found[k] for k in planned], expected)
        same(f"{what} of the others", [found[k] for k in others], standing)

    same("profile", header.profile, "ros2")
    same("messages", summary.statistics.message_count, len(times) + 1)
    same("start and end", [summary.statistics.message_start_time, summary.statistics.message_end_time], [0, times[-1]])

    states = messages["/joint_states"]
    same("states", len(states), len(times))
    for k, (name, message, state) in enumerate(states):
        same("type", name, "sensor_msgs/msg/JointState")
        same(f"times of state {k}", [message.log_time, nanoseconds(state.header.stamp)], [times[k], times[k]])
        same("joints", state.name, names)
        same_rows(f"position {k}", state.position, trajectory["position"][k], held)
        same_rows(f"velocity {k}", state.velocity, trajectory["velocity"][k], [0.0] * len(others))
        same("effort", state.effort, [])

    same("trajectories", len(messages["/joint_trajectory"]), 1)
    [(name, message, motion)] = messages["/joint_trajectory"]
    same("type", name, "trajectory_msgs/msg/JointTrajectory")
    same("time of the trajectory", [message.log_time, nanoseconds(motion.header.stamp)], [0, 0])
    same("points", len(motion.points), len(times))
    for k, point in enumerate(motion.points):
        same(f"time of point {k}", nanoseconds(point.time_from_start), times[k])
        same_rows(f"point {k}", point.positions, trajectory["position"][k], held)
        same_rows(f"velocity of point {k}", point.velocities, trajectory["velocity"][k], [0.0] * len(others))
        same(f"acceleration of point {k}", point.accelerations, [])
        same("effort", point.effort, [])

    first, last = (state.position for _, _, state in (states[0], states[-1]))
    motion = f"{len(names)} joints, {len(states)} states from {first} to {last} in {times[-1] * 1e-9:.3f} s"
    print(f"{mcap_file}: {header.library}, {motion}: as in {json_file}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
