#!/usr/bin/env python3
"""rostopic and rosservice know what the nodes say: each message and service of the package, and ROS's own on its topics.

Usage: messages_test.py PACKAGE_FOLDER, with the package's Python messages on PYTHONPATH."""
import pathlib
import sys

import roslib.message

ROS_OWN = ("geometry_msgs/PoseWithCovarianceStamped", "nav_msgs/Odometry", "sensor_msgs/Image", "sensor_msgs/CameraInfo",
           "sensor_msgs/Imu", "sensor_msgs/BatteryState", "tf2_msgs/TFMessage", "diagnostic_msgs/DiagnosticArray",
           "visualization_msgs/MarkerArray")


def main():
    package = pathlib.Path(sys.argv[1])
    messages = [f"lodestar/{path.stem}" for path in sorted(package.glob("msg/*.msg"))]
    services = [f"lodestar/{path.stem}" for path in sorted(package.glob("srv/*.srv"))]
    if not messages or not services:
        sys.exit(f"{package} holds no messages or no services")
    missing = [name for name in (*messages, *ROS_OWN) if roslib.message.get_message_class(name) is None]
    missing += [name for name in services if roslib.message.get_service_class(name) is None]
    if missing:
        sys.exit("Python cannot load: " + ", ".join(missing))
    print(f"{len(messages)} messages and {len(services)} services of the package, {len(ROS_OWN)} of ROS's own")


if __name__ == "__main__":
    main()
