"""Reads a recording with the format's own Python packages and compares it with the JSON result of the same run.

    read_mcap.py RESULT.json RESULT.mcap

It decodes the messages only by the definitions in the file. Positions and velocities of the planned joints must be the same
doubles, and times the same nanoseconds. Other joints must not move, and there must be no accelerations. The links' frames must
turn with the joints, and each must have a surface and points. The exit code is 0 if everything agrees.
"""

import json
import math
import sys
from collections import defaultdict

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def nanoseconds(time):
    """Converts a Time or Duration message to a number."""
    assert 0 <= time.nanosec < 10**9, time
    return time.sec * 10**9 + time.nanosec


def same(what, found, expected):
    """Ends the program unless both are equal."""
    if found != expected:
        sys.exit(f"{what}: {found} in the recording, {expected} expected")


def turn(orientation):
    """Returns the angle of a rotation about z, in radians."""
    same("axis", [orientation.x, orientation.y], [0.0, 0.0])
    return 2 * math.atan2(orientation.z, orientation.w)


def same_scene(messages, result, times):
    """Compares the pictures of the motion; returns a description."""
    frames = defaultdict(dict)
    for name, message, moved in messages["/tf"]:
        same("type", name, "tf2_msgs/msg/TFMessage")
        for transform in moved.transforms:
            same("stamp", nanoseconds(transform.header.stamp), message.log_time)
            frames[transform.child_frame_id][message.log_time] = transform.transform
    links = [frames[name] for name in frames if name.startswith("link/")]
    same("links", len(links), 2)
    for link, joints in zip(links, (1, 2)):
        # Joints that turn clockwise, or slide, make other angles: all of them have the same sign, or none.
        turned = [turn(link[time].rotation) - turn(link[times[0]].rotation) for time in times if time in link]
        asked = [sum(q[:joints]) - sum(result["trajectory"]["position"][0][:joints])
                 for time, q in zip(times, result["trajectory"]["position"]) if time in link]
        wrong = max(abs(math.remainder(a - b, 2 * math.pi)) for a, b in zip(turned, asked))
        if result["units"] == ["rad", "rad"] and wrong > 1e-9:
            sys.exit(f"frame of link {joints}: it turns by {wrong} rad more than its joints")
    [(name, message, scene)] = messages["/scene"]
    same("type", name, "visualization_msgs/msg/MarkerArray")
    for marker in scene.markers:
        same(f"whole triangles of {marker.id}", len(marker.points) % 3, 0)
        same(f"frame of {marker.id}", marker.header.frame_id in frames, True)
    for topic in (topic for topic in messages if topic.startswith("/outlines/")):
        [(name, message, cloud)] = messages[topic]
        same("type", name, "sensor_msgs/msg/PointCloud2")
        same(f"bytes of {topic}", len(cloud.data), cloud.width * cloud.point_step)
    return f"{len(scene.markers)} surfaces in {len(frames)} frames"


def main(json_file, mcap_file):
    with open(json_file, encoding="utf-8") as file:
        result = json.load(file)
    trajectory, joints = result["trajectory"], result["joints"]
    times = [round(time * 1e9) for time in trajectory["time"]]

    with open(mcap_file, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        header, summary = reader.get_header(), reader.get_summary()
        messages = defaultdict(list)
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

    shown = same_scene(messages, result, times)
    first, last = (state.position for _, _, state in (states[0], states[-1]))
    motion = f"{len(names)} joints, {len(states)} states from {first} to {last} in {times[-1] * 1e-9:.3f} s"
    print(f"{mcap_file}: {header.library}, {motion}, {shown}: as in {json_file}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
