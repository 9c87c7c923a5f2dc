#!/usr/bin/env python3
"""Plays a bag to robot_localization's EKF and writes what it says as replay's CSV; prints its processor time (s).

Usage: run_robot_localization.py --node ekf_localization_node --bag X.bag --params P.yaml --out EST.csv [--defaults]
--defaults takes from P.yaml only topics, their _config and the frames; all else is as robot_localization comes.
Needs a machine with robot_localization; everything runs under a master of its own.
"""
import argparse
import math
import os
import socket
import subprocess
import sys
import tempfile
import time

import yaml

HEADER = "stamp_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,beacons_used,mode"
SPEED = 4  # times real time
CLOCK_HZ = 1000  # of /clock; the node integrates by simulated time, which at rosbag's 100 would go in steps of 40 ms


def diagonal(sigmas):
    n = len(sigmas)
    return [sigmas[i] ** 2 if i == j else 0.0 for i in range(n) for j in range(n)]


def with_covariances(source, target):
    """Our bags leave the covariances of wheels and inertial sensor to the vehicle file; theirs come in the messages."""
    import rosbag
    with rosbag.Bag(target, "w") as out:
        for topic, message, received in rosbag.Bag(source).read_messages():
            if topic == "/odom":
                message.twist.covariance = diagonal([0.02, 0.02, 0, 0, 0, 0.01])
            if topic == "/imu/data":
                message.angular_velocity_covariance = diagonal([0.002] * 3)
                message.linear_acceleration_covariance = diagonal([0.2] * 3)  # bias and tilt are no states of theirs
            out.write(topic, message, received)


def angles(q):
    return (math.atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y)),
            math.asin(max(-1, min(1, 2 * (q.w * q.y - q.z * q.x)))),
            math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z)))


def record(out):
    import rospy
    from nav_msgs.msg import Odometry

    file = open(out, "w")
    file.write(HEADER + "\n")
    last = [0.0]

    def take(message):
        p, q, c = message.pose.pose.position, message.pose.pose.orientation, message.pose.covariance
        stamp = message.header.stamp
        if stamp.to_sec() <= last[0]:
            return
        last[0] = stamp.to_sec()
        roll, pitch, yaw = angles(q)
        file.write("%d.%09d,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.6f,%.6f,%.7f,0,tracking\n" % (
            stamp.secs, stamp.nsecs, p.x, p.y, p.z, roll, pitch, yaw, c[0] ** 0.5, c[7] ** 0.5, c[35] ** 0.5))

    rospy.init_node("recorder")
    rospy.Subscriber("/odometry/filtered", Odometry, take, queue_size=1000)
    return file


def processor_s(pid):
    with open("/proc/%d/stat" % pid) as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def bare(parameters):
    return {key: value for key, value in parameters.items()
            if key.endswith(("_config", "_frame")) or key in ("odom0", "imu0", "pose0", "publish_tf")}


def wait_for_master(port):
    end = time.time() + 30
    while time.time() < end:
        try:
            socket.create_connection(("localhost", port), 1).close()
            return
        except OSError:
            time.sleep(0.1)
    sys.exit("roscore does not answer on port %d" % port)


def main():
    parser = argparse.ArgumentParser()
    for name in ("--node", "--bag", "--params", "--out"):
        parser.add_argument(name, required=True)
    parser.add_argument("--defaults", action="store_true")
    options = parser.parse_args()
    with open(options.params) as file:
        parameters = yaml.safe_load(file)
    if options.defaults:
        parameters = bare(parameters)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
    try:
        socket.gethostbyname(socket.gethostname())
    except OSError:
        os.environ["ROS_HOSTNAME"] = "localhost"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    started = []
    with tempfile.TemporaryDirectory() as folder:
        bag = os.path.join(folder, "drive.bag")
        with_covariances(options.bag, bag)
        params = os.path.join(folder, "params.yaml")
        with open(params, "w") as file:
            yaml.safe_dump(parameters, file)
        try:
            started.append(subprocess.Popen(["roscore", "-p", str(port)], **quiet))
            wait_for_master(port)
            subprocess.check_call(["rosparam", "set", "/use_sim_time", "true"], **quiet)
            subprocess.check_call(["rosparam", "load", params, "/ekf"], **quiet)
            node = subprocess.Popen([options.node, "__name:=ekf"], **quiet)
            started.append(node)
            file = record(options.out)
            time.sleep(2)
            subprocess.check_call(["rosbag", "play", "--clock", "--hz", str(CLOCK_HZ), "-d", "2", "-r", str(SPEED), bag,
                                   "--topics", "/odom", "/imu/data", "/beacons/fix", "/tf_static"], **quiet)
            if node.poll() is not None:
                sys.exit("%s ended during the drive (code %d)" % (options.node, node.returncode))
            print("%.3f" % processor_s(node.pid))
            time.sleep(1)
            file.close()
        finally:
            for process in reversed(started):
                process.terminate()
                process.wait()
    return 0


sys.exit(main())
