"""The elements and attributes of URDF, as urdfdom reads them."""

from __future__ import annotations

from sambot_viz.robot.slips.vocabulary import Vocabulary, Word

_PLACE = {"origin": "position offset translation location transform"}
_SYNONYMS = {
    "origin": {
        "xyz": "pos position trans translation translate location offset",
        "rpy": "rot rotation orientation euler angles",
    },
    "box": {"size": "dim dims dimension dimensions extent extents"},
    "cylinder": {"radius": "r rad", "length": "h l len"},
    "sphere": {"radius": "r rad"},
    "mesh": {"filename": "file path uri url src source", "scale": "scaling"},
    "texture": {"filename": "file path uri url src source"},
    "color": {"rgba": "value"},
    "mass": {"value": "m mass kg"},
    "parent": {"link": "name"},
    "child": {"link": "name"},
    "axis": {"xyz": "dir direction axis value vector"},
    "limit": {
        "lower": "min minimum low",
        "upper": "max maximum high",
        "effort": "torque force",
        "velocity": "vel speed",
    },
    "mimic": {"joint": "name", "multiplier": "ratio factor mult gear"},
    "joint": _PLACE,
    "visual": _PLACE,
    "collision": _PLACE,
    "inertial": _PLACE,
    "geometry": {"box": "cube cuboid", "sphere": "ball"},
}
_WORDS = {
    "robot": Word(
        "name version",
        many="link joint material gazebo transmission ros2_control",
        also="sensor loop_joint",
    ),
    "link": Word("name type", "inertial", "visual collision", "contact sensor"),
    "visual": Word("name", "origin geometry material"),
    "collision": Word("name", "origin geometry", also="material verbose"),
    "inertial": Word("", "origin mass inertia"),
    "geometry": Word("", "box cylinder sphere mesh capsule", one_of=True),
    "material": Word("name", "color texture"),
    "joint": Word(
        "name type",
        "origin parent child axis limit dynamics calibration mimic safety_controller",
    ),
    "origin": Word("xyz rpy quat_xyzw"),
    "box": Word("size"),
    "cylinder": Word("radius length"),
    "capsule": Word("radius length"),
    "sphere": Word("radius"),
    "mesh": Word("filename scale"),
    "texture": Word("filename"),
    "color": Word("rgba"),
    "mass": Word("value"),
    "inertia": Word("ixx ixy ixz iyy iyz izz"),
    "parent": Word("link"),
    "child": Word("link"),
    "axis": Word("xyz"),
    "limit": Word("lower upper effort velocity acceleration deceleration jerk"),
    "dynamics": Word("damping friction"),
    "calibration": Word("rising falling reference_position"),
    "mimic": Word("joint multiplier offset"),
    "safety_controller": Word(
        "soft_lower_limit soft_upper_limit k_position k_velocity"
    ),
    "gazebo": Word("reference", opaque=True),
    "transmission": Word("name", opaque=True),
}
URDF = Vocabulary(
    "robot",
    _WORDS,
    {
        f"{tag}.{word}": right
        for tag, rows in _SYNONYMS.items()
        for right, words in rows.items()
        for word in words.split()
    },
    {
        "geometry": "visual",
        **dict.fromkeys(("box", "cylinder", "sphere", "mesh", "capsule"), "geometry"),
    },
)
