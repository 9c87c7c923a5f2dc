#!/usr/bin/env python3
"""Plays a bag to robot_localization's EKF and writes what it says as replay's CSV; prints its processor time (s).

Usage: run_robot_localization.py --node ekf_localization_node --bag X.bag --params P.yaml --out EST.csv
Needs a machine with robot_localization; everything runs under a master of its own.
"""
import argparse
import os
import socket
import subprocess
import sys
import tempfile
import time

HEADER = "stamp_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,beacons_used,mode"
SPEED = 4  # times real time


def with_covariances(source, target):
    """Our bags leave the covariances of wheels and inertial sensor to the vehicle file; theirs come in the messages."""
    import rosbag
    with rosbag.Bag(target, "w") as out:
        for topic, message, received in rosbag.Bag(source).read_messages():
            if topic == "/odom":
                for i, sigma in ((0, 0.02), (7, 0.02), (35, 0.01)):
                    message.twist.covariance[i] = sigma ** 2
            if topic == "/imu/data":
                for i in (0, 4, 8):
                    message.angular_velocity_covariance[i] = 0.002 ** 2
                    message.linear_acceleration_covariance[i] = 0.05 ** 2
            out.write(topic, message, received)


def record(out):
    import rospy
    from nav_msgs.msg import Odometry
    from tf.transformations import euler_from_quaternion

    file = open(out, "w")
    file.write(HEADER + "\n")
    last = [0.0]

    def take(message):
        p, q, c = message.pose.pose.position, message.pose.pose.orientation, message.pose.covariance
        stamp = message.header.stamp
        if stamp.to_sec() <= last[0]:
            return
        last[0] = stamp.to_sec()
        roll, pitch, yaw = euler_from_quaternion([q.x, q.y, q.z, q.w])
        file.write("%d.%09d,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.6f,%.6f,%.7f,0,tracking\n" % (
            stamp.secs, stamp.nsecs, p.x, p.y, p.z, roll, pitch, yaw, c[0] ** 0.5, c[7] ** 0.5, c[35] ** 0.5))

    rospy.init_node("recorder")
    rospy.Subscriber("/odometry/filtered", Odometry, take, queue_size=1000)
    return file


def processor_s(pid):
    with open("/proc/%d/stat" % pid) as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    parser = argparse.ArgumentParser()
    for name in ("--node", "--bag", "--params", "--out"):
        parser.add_argument(name, required=True)
    options = parser.parse_args()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    started = []
    with tempfile.TemporaryDirectory() as folder:
        bag = os.path.join(folder, "drive.bag")
        with_covariances(options.bag, bag)
        try:
            started.append(subprocess.Popen(["roscore", "-p", str(port)], **quiet))
            time.sleep(3)
            subprocess.check_call(["rosparam", "set", "/use_sim_time", "true"], **quiet)
            subprocess.check_call(["rosparam", "load", options.params, "/ekf"], **quiet)
            node = subprocess.Popen([options.node, "__name:=ekf"], **quiet)
            started.append(node)
            file = record(options.out)
            time.sleep(2)
            subprocess.check_call(["rosbag", "play", "--clock", "-r", str(SPEED), bag, "--topics", "/odom", "/imu/data",
                                   "/beacons/fix", "/tf_static"], **quiet)
            print("%.3f" % processor_s(node.pid))
            file.close()
        finally:
            for process in reversed(started):
                process.terminate()
                process.wait()
    return 0


sys.exit(main())
