"""Small files of each joint-angle format, and what Choregraphe's XML is built of."""

from __future__ import annotations

import numpy as np

from nao_sim.motion import JointTrajectory

MOTION = JointTrajectory(
    [0.0, 0.5, 1.25],
    np.where(np.isin(np.arange(26), [0, 3, 13]), [[0.1], [-0.2], [0.3]], np.nan),
    np.isin(np.arange(26), [0, 3, 13]),
)
TABLE = """\
RSR,RSP,RER,REY,RH,LSR,LSP,LER,LEY,LH,Behavior
0,0,180,0,0,0,0,180,0,0,forward
60,0,90,0,90,-60,0,90,0,90,piUp
"""
# As Choregraphe exports it, in Python 2.
EXPORT = """\
# Choregraphe simplified export in Python.
from naoqi import ALProxy
names = list()
times = list()
keys = list()

names.append("HeadYaw")
times.append([0.4, 1.4])
keys.append([0.1, -0.2])

names.append("LHand")
times.append([1.4])
keys.append([0.5])

try:
  # uncomment the following line and modify the IP if you use this script outside Choregraphe.
  # motion = ALProxy("ALMotion", IP, 9559)
  motion = ALProxy("ALMotion")
  motion.angleInterpolation(names, keys, times, True);
except BaseException, err:
  print err
"""
LINEAR = "".join(
    f'<Tangent side="{side}" interpType="linear" abscissaParam="0" ordinateParam="0" />' for side in ("left", "right")
)


def key(frame, value, inside=""):
    return f'<Key frame="{frame}" value="{value}">{inside}</Key>\n'


def actuator(name, *keys, unit="0", more='mute="0"'):
    return f'<ActuatorCurve name="value" actuator="{name}" {more} unit="{unit}">\n{"".join(keys)}</ActuatorCurve>\n'


def timeline(*curves, attributes='enable="1" fps="25" start_frame="1" end_frame="-1" size="150"'):
    return f"<Timeline {attributes}>\n<ActuatorList>\n{''.join(curves)}</ActuatorList>\n</Timeline>\n"


def box(name, content):
    script = "<script><content><![CDATA[import os; os.remove('x')]]></content></script>"
    return f'<Box name="{name}" id="1">\n{script}\n{content}</Box>\n'


def project(*content):
    schema = "http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd"
    return (
        f'<?xml version="1.0" encoding="UTF-8" ?>\n<ChoregrapheProject xmlns="{schema}" xar_version="3">\n'
        f"{''.join(content)}</ChoregrapheProject>\n"
    )


YAW_CURVE = actuator("HeadYaw", key(1, 0, LINEAR), key(26, 30, LINEAR), key(51, -15, LINEAR))
HAND_CURVE = actuator("LHand", key(26, 0.25), unit="1")
BEHAVIOUR = project(box("root", timeline(attributes='enable="0"') + box("Wave", timeline(YAW_CURVE, HAND_CURVE))))
