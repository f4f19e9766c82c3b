"""Compares the torques of results with Pinocchio for the same URDF: inverse dynamics by its recursive Newton-Euler algorithm.

    python tests/python/torques.py ROBOT.urdf RESULT.json ...
"""

import json
import sys

import numpy
import pinocchio

# Of both, relative to the joint's greatest torque.
ROUNDING = 1e-9


def torques(model, joints, trajectory):
    """Returns the torques of the joints at each sample; all other joints are at zero."""
    data = model.createData()
    of = [model.joints[model.getJointId(name)] for name in joints]
    for rows in zip(trajectory["position"], trajectory["velocity"], trajectory["acceleration"]):
        q, v, a = pinocchio.neutral(model), numpy.zeros(model.nv), numpy.zeros(model.nv)
        for joint, position, velocity, acceleration in zip(of, *rows):
            # Joints without limits are points of the unit circle.
            turns = joint.nq == 2
            q[joint.idx_q : joint.idx_q + joint.nq] = [numpy.cos(position), numpy.sin(position)] if turns else position
            v[joint.idx_v], a[joint.idx_v] = velocity, acceleration
        torque = pinocchio.rnea(model, data, q, v, a)
        yield [torque[joint.idx_v] for joint in of]


def main(urdf, results):
    model = pinocchio.buildModelFromUrdf(urdf)
    for name in results:
        with open(name) as file:
            result = json.load(file)
        trajectory = result["trajectory"]
        found = numpy.array(trajectory["torque"])
        expected = numpy.array(list(torques(model, result["joints"], trajectory)))
        assert found.shape == expected.shape and len(found) > 100, name
        greatest = numpy.abs(expected).max(axis=0)
        off = (numpy.abs(found - expected) / greatest).max()
        assert off < ROUNDING, f"{name}: off by {off} of the greatest torque"
        print(f"{name}: {len(found)} samples, torques up to {greatest}, off by {off:.1e}")


main(sys.argv[1], sys.argv[2:])
