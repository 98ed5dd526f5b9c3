//! The types of messages of ROS 2 that recordings hold, as their fields define them (`ros2msg`).

/// A type of messages: its name, and its definition with those of the types in it.
pub(super) struct MessageType {
    /// The name of the type.
    pub(super) name: &'static str,
    /// The definition, and those that it needs, each with its name.
    parts: &'static [(&'static str, &'static str)],
}

const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const DURATION: (&str, &str) = ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n");
const HEADER: (&str, &str) = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");

/// A text.
pub(super) const STRING: MessageType =
    MessageType { name: "std_msgs/msg/String", parts: &[("", "string data\n")] };

/// Poses of frames in others.
pub(super) const TRANSFORMS: MessageType = MessageType {
    name: "tf2_msgs/msg/TFMessage",
    parts: &[
        ("", "geometry_msgs/TransformStamped[] transforms\n"),
        (
            "geometry_msgs/TransformStamped",
            "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
        ),
        ("geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"),
        ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"),
        ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"),
        HEADER,
        TIME,
    ],
};

/// Positions, velocities and efforts of joints.
pub(super) const JOINT_STATE: MessageType = MessageType {
    name: "sensor_msgs/msg/JointState",
    parts: &[
        (
            "",
            "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
        ),
        HEADER,
        TIME,
    ],
};

/// A trajectory of joints.
pub(super) const JOINT_TRAJECTORY: MessageType = MessageType {
    name: "trajectory_msgs/msg/JointTrajectory",
    parts: &[
        ("", "std_msgs/Header header\nstring[] joint_names\ntrajectory_msgs/JointTrajectoryPoint[] points\n"),
        (
            "trajectory_msgs/JointTrajectoryPoint",
            "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n\
             builtin_interfaces/Duration time_from_start\n",
        ),
        DURATION,
        HEADER,
        TIME,
    ],
};

/// A line of a log.
pub(super) const LOG: MessageType = MessageType {
    name: "rcl_interfaces/msg/Log",
    parts: &[
        (
            "",
            "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\n\
             uint32 line\n",
        ),
        TIME,
    ],
};

impl MessageType {
    /// Returns the definition of the type as recordings hold it: those of the types in it stand behind, each after a line
    /// of 80 `=` and its name.
    pub(super) fn definition(&self) -> String {
        let part = |(name, fields): &(&str, &str)| match *name {
            "" => (*fields).to_owned(),
            name => format!("{}\nMSG: {name}\n{fields}", "=".repeat(80)),
        };
        self.parts.iter().map(part).collect()
    }
}
