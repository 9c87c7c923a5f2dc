find_package(catkin REQUIRED)
catkin_package()
