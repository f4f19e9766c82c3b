#!/usr/bin/env python3
"""Sends a plan of cplan to a joint_trajectory_controller of ROS 2, as a goal of its action FollowJointTrajectory.

The plan is a file that cplan has written: .yaml (every joint of the robot) or .json. Unlike `ros2 action send_goal`, the
goal does not go through a command line, so it may be of any length.

Before it sends anything, the program checks the rules of the controller, and whether the robot stands at the start.
`--check` does only this, and needs no ROS.

    send.py plan.yaml --check --joints axis_1,axis_2,axis_3,axis_4
    send.py plan.yaml --controller scara_controller

Exit codes: 0 done (or no rule is broken), 1 a rule is broken or the controller reports an error, 2 wrong command line.
"""

import argparse
import json
import math
import sys
from pathlib import Path

# Velocity below which the controller takes the last point to be at rest: the resolution of a float at 1.
REST = 1.1920929e-07

# Largest distance between the robot and the first point, radians or metres. The controller itself does not check this: it
# would move there at once.
AT_START = 0.01

# The meaning of the controller's error codes, from control_msgs/action/FollowJointTrajectory.
ERRORS = {
    0: "done",
    -1: "the goal is invalid",
    -2: "the joints are not those of the controller",
    -3: "the goal is too old",
    -4: "a joint was outside the tolerance of the path",
    -5: "a joint did not reach the goal within its tolerance",
}


def nanoseconds(time):
    """Returns a time in whole nanoseconds."""
    return int(time["sec"]) * 10**9 + int(time["nanosec"])


def read(path):
    """Reads a plan as the names of its joints and its points: time in nanoseconds, positions, velocities, accelerations."""
    text = Path(path).read_text(encoding="utf-8")
    if path.endswith(".json"):
        return of_result(json.loads(text))
    try:
        import yaml
    except ImportError:
        raise ValueError("this Python lacks the package yaml (PyYAML), which .yaml files need; give the plan's .json") from None
    try:
        message = yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except yaml.YAMLError as error:
        raise ValueError(f"this is not YAML: {error}") from None
    if not isinstance(message, dict) or "points" not in message or "joint_names" not in message:
        raise ValueError("this is no JointTrajectory, which cplan writes with --output plan.yaml")
    points = message["points"] or []
    rows = [(nanoseconds(p["time_from_start"]), *(p.get(k) or [] for k in FIELDS)) for p in points]
    return list(message["joint_names"]), rows


FIELDS = ("positions", "velocities", "accelerations")


def of_result(result):
    """Returns joints and points of a result in JSON."""
    if not isinstance(result, dict) or "trajectory" not in result:
        raise ValueError("this result has no motion")
    motion = result.get("all_joints") or {"joints": result["joints"], **result["trajectory"]}
    # Samples lie at whole nanoseconds. The accelerations of results may jump, so they are not for controllers.
    rows = zip(motion["time"], motion["position"], motion["velocity"])
    return motion["joints"], [(round(time * 1e9), position, velocity, []) for time, position, velocity in rows]


def faults(joints, points, of_controller=None, state=None):
    """Lists the rules of joint_trajectory_controller that a trajectory breaks, in words.

    `of_controller` are the names of the controller's joints, and `state` is the position of each joint, if known.
    """
    found = []
    if not joints:
        found.append("it names no joints")
    if not points:
        found.append("it has no points")
    found += [f'joint "{name}" is named twice' for name in sorted({name for name in joints if joints.count(name) > 1})]
    if of_controller is not None:
        found += [f'the controller has no joint "{name}"' for name in joints if name not in of_controller]
        missing = [name for name in of_controller if name not in joints]
        found += [f'it lacks joint "{name}" of the controller; cplan writes all joints into .yaml' for name in missing]
    before = None
    for index, (time, *values) in enumerate(points):
        if time < 0 or before is not None and time <= before:
            found.append(f"the times do not increase strictly: point {index + 1} is at {time / 1e9} s")
        before = time
        for field, numbers in zip(FIELDS, values):
            if len(numbers) != len(joints) and (numbers or field == "positions"):
                found.append(f"point {index + 1} has {len(numbers)} {field} for {len(joints)} joints")
            if not all(isinstance(x, (int, float)) and math.isfinite(x) for x in numbers):
                found.append(f"point {index + 1} has {field} that are not finite numbers")
        if len(found) > 20:
            return found + ["and possibly more"]
    if not found:
        moving = [f'joint "{name}" has the velocity {v} at the end' for name, v in zip(joints, points[-1][2]) if abs(v) > REST]
        found += moving
    if not found and state is not None:
        for name, start in zip(joints, points[0][1]):
            at = state.get(name)
            if at is None:
                found.append(f'the position of joint "{name}" is unknown')
            elif abs(at - start) > AT_START:
                found.append(f'joint "{name}" is at {at:.4f}, and the plan begins at {start:.4f}: move the robot there first')
    return found


def send(joints, points, controller, timeout):
    """Checks the robot's state and sends the trajectory. Returns the faults."""
    import rclpy
    from action_msgs.msg import GoalStatus
    from control_msgs.action import FollowJointTrajectory
    from rclpy.action import ActionClient
    from sensor_msgs.msg import JointState
    from trajectory_msgs.msg import JointTrajectoryPoint

    rclpy.init()
    node = rclpy.create_node("cplan_send")
    try:
        state = {}
        node.create_subscription(JointState, "/joint_states", lambda m: state.update(zip(m.name, m.position)), 10)
        client = ActionClient(node, FollowJointTrajectory, f"/{controller}/follow_joint_trajectory")
        if not client.wait_for_server(timeout_sec=timeout):
            return [f"no action server /{controller}/follow_joint_trajectory within {timeout} s: is the controller active?"]
        end = node.get_clock().now().nanoseconds + int(timeout * 1e9)
        while not all(name in state for name in joints) and node.get_clock().now().nanoseconds < end:
            rclpy.spin_once(node, timeout_sec=0.1)
        found = faults(joints, points, state=state)
        if found:
            return found
        goal = FollowJointTrajectory.Goal()
        goal.trajectory.joint_names = joints
        for time, positions, velocities, accelerations in points:
            point = JointTrajectoryPoint(positions=positions, velocities=velocities, accelerations=accelerations)
            point.time_from_start.sec, point.time_from_start.nanosec = divmod(time, 10**9)
            goal.trajectory.points.append(point)
        accepted = client.send_goal_async(goal)
        rclpy.spin_until_future_complete(node, accepted)
        handle = accepted.result()
        if not handle.accepted:
            return ["the controller refuses the goal: its log names the reason"]
        done = handle.get_result_async()
        rclpy.spin_until_future_complete(node, done)
        result, status = done.result().result, done.result().status
        if status == GoalStatus.STATUS_SUCCEEDED and result.error_code == 0:
            return []
        reason = ERRORS.get(result.error_code, f"error {result.error_code}")
        return [f"{reason}. {result.error_string}".strip()]
    finally:
        node.destroy_node()
        rclpy.shutdown()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plan", help="file of cplan: .yaml or .json")
    parser.add_argument("--controller", default="joint_trajectory_controller", help="name of the controller")
    parser.add_argument("--check", action="store_true", help="only check the file; ROS is not needed")
    parser.add_argument("--joints", type=lambda text: text.split(","), help="names of the controller's joints: a,b,c")
    parser.add_argument("--timeout", type=float, default=5.0, help="seconds to wait for the controller")
    args = parser.parse_args()
    try:
        joints, points = read(args.plan)
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"error: {args.plan}: {error}", file=sys.stderr)
        return 1
    found = faults(joints, points, args.joints)
    if not found and not args.check:
        try:
            found = send(joints, points, args.controller, args.timeout)
        except ImportError as error:
            found = [f"{error}: source the setup.bash of ROS 2, or use --check"]
    for fault in found:
        print(f"error: {args.plan}: {fault}", file=sys.stderr)
    if not found:
        seconds = points[-1][0] / 1e9
        print(f"{args.plan}: {len(points)} points, {seconds} s, {len(joints)} joints: {'no rule is broken' if args.check else 'done'}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
