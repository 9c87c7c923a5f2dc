#!/usr/bin/python3
"""lint.py finds each kind of fault in a small tree made for it."""
import os
import tempfile
import unittest

import lint

TREE = {
    "ARCHITECTURE.md": "| module | folder | may include |\n|---|---|---|\n| common | base/common | |\n"
                       "| pose | estimation/pose | common |\n| sim | sim | * |\n| ros | ros | * |\n| apps | apps | * |\n",
    "CMakeLists.txt": "lodestar_module(common DIR base/common LINKS Eigen3::Eigen)\n"
                      "lodestar_module(pose DIR estimation/pose LINKS lodestar_common PRIVATE Ceres::ceres)\n"
                      "lodestar_module(sim DIR sim LINKS lodestar_pose)\n",
    "package.xml": "<package><depend>roscpp</depend></package>\n",
    "cmake/ros.cmake": "set(LODESTAR_ROS_COMPONENTS\n  roscpp)\n",
    "src/estimation/pose/a.cpp": '#include "lodestar/base/common/a.hpp"\n',
    "src/ros/convert/a.cpp": '#include <ros/ros.h>\n#include "lodestar/IrFrame.h"\n#include "lodestar/sim/a.hpp"\n',
    "src/apps/a.cpp": '#include "lodestar/ros/bag/recording.hpp"\n#include "lodestar/sim/a.hpp"\n',
    "config/a.yaml": "a: [1, 2]\n",
    "launch/a.launch": "<launch/>\n",
}


def faults_of(changes):
    with tempfile.TemporaryDirectory() as root:
        for path, text in {**TREE, **changes}.items():
            full = os.path.join(root, path)
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, "w", encoding="utf-8") as file:
                file.write(text)
        return lint.lint(root)


class LintTest(unittest.TestCase):
    def assert_fault(self, changes, part):
        faults = faults_of(changes)
        self.assertEqual(len(faults), 1, faults)
        self.assertIn(part, faults[0])

    def test_sound_tree(self):
        self.assertEqual(faults_of({}), [])

    def test_include_of_another_room(self):
        self.assert_fault({"src/estimation/pose/b.cpp": '\n#include "lodestar/sim/a.hpp"\n'},
                          "b.cpp:2: pose may not include sim")
        self.assert_fault({"include/lodestar/base/common/b.hpp": '#include "lodestar/estimation/pose/a.hpp"\n'},
                          "common may not include pose")

    def test_ros_outside_its_room(self):
        for header in ("<ros/time.h>", "<sensor_msgs/Image.h>", "<tf2_ros/buffer.h>", '"lodestar/IrFrame.h"'):
            self.assert_fault({"src/sim/b.cpp": "#include %s\n" % header}, "includes ROS")
        self.assert_fault({"include/lodestar/ros/bag/recording.hpp": "#include <ros/time.h>\n"}, "includes ROS")

    def test_edge_outside_its_rooms(self):
        self.assert_fault({"src/sim/b.cpp": '#include "lodestar/ros/bag/recording.hpp"\n'}, "sim may not include ros")
        self.assert_fault({"src/apps/b.cpp": '#include "lodestar/ros/convert/a.hpp"\n'}, "apps see the edge through")

    def test_opencv_in_base(self):
        self.assert_fault({"src/base/common/b.cpp": "#include <opencv2/core.hpp>\n"}, "OpenCV")

    def test_file_in_no_room(self):
        self.assert_fault({"src/utils/b.cpp": "\n"}, "lies in no module")

    def test_link_of_another_room(self):
        cmake = TREE["CMakeLists.txt"].replace("LINKS lodestar_common", "LINKS lodestar_common lodestar_sim")
        self.assert_fault({"CMakeLists.txt": cmake.replace("sim LINKS lodestar_pose", "sim LINKS x")},
                          "pose may not link sim")

    def test_private_links_end_at_their_module(self):
        cmake = TREE["CMakeLists.txt"] + "lodestar_module(yaml DIR base/yaml LINKS x)\n"
        table = TREE["ARCHITECTURE.md"].replace("| sim |", "| yaml | base/yaml | |\n| sim |")
        rooms = table.replace("| common | base/common | |", "| common | base/common | yaml |")
        links = cmake.replace("Eigen3::Eigen", "Eigen3::Eigen PRIVATE lodestar_yaml")
        self.assertEqual(faults_of({"ARCHITECTURE.md": rooms, "CMakeLists.txt": links}), [])
        self.assert_fault({"ARCHITECTURE.md": rooms, "CMakeLists.txt": links.replace(" PRIVATE lodestar_y", " lodestar_y")},
                          "pose may not link yaml")

    def test_page_links_to_nothing(self):
        self.assertEqual(faults_of({"docs/a.md": "[b](../config/a.yaml#x) [c](https://x.y/z) [d](#e)\n"}), [])
        self.assert_fault({"docs/a.md": "\n[b](b.md)\n"}, "docs/a.md:2: links to b.md")
        self.assert_fault({"README.md": "![b](docs/b.png)\n"}, "links to docs/b.png")

    def test_module_missing_in_cmake_or_table(self):
        self.assert_fault({"CMakeLists.txt": TREE["CMakeLists.txt"].split("lodestar_module(sim")[0]},
                          "module sim of the table is not in CMakeLists.txt")
        self.assert_fault({"CMakeLists.txt": TREE["CMakeLists.txt"] + "lodestar_module(new DIR new LINKS x)\n"},
                          "module new in new is not")

    def test_package_lacks_a_component(self):
        self.assert_fault({"cmake/ros.cmake": "set(LODESTAR_ROS_COMPONENTS roscpp nodelet)\n"}, "does not name nodelet")

    def test_unreadable_files(self):
        self.assert_fault({"config/b.yaml": "a: [1, 2\n"}, "is not YAML")
        self.assert_fault({"launch/b.launch": "<launch>\n"}, "is not XML")
        self.assert_fault({"src/sim/b.cpp": "int x;"}, "newline")
        self.assert_fault({"scripts/b": "echo no shebang line is no script of ours"}, "newline")


if __name__ == "__main__":
    unittest.main()
