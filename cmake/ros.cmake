# What the edge stands on, the messages, and where programs and files go. Upstream's names, as package.xml has them.
set(LODESTAR_ROS_COMPONENTS
  roscpp nodelet pluginlib
  std_msgs geometry_msgs sensor_msgs nav_msgs visualization_msgs diagnostic_msgs tf2_msgs
  tf2 tf2_ros image_transport camera_info_manager diagnostic_updater dynamic_reconfigure
  rosbag_storage
  message_generation)
find_package(catkin REQUIRED COMPONENTS ${LODESTAR_ROS_COMPONENTS})

add_message_files(DIRECTORY msg)
add_service_files(DIRECTORY srv)
generate_messages(DEPENDENCIES std_msgs geometry_msgs)

file(GLOB cfg_files CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} cfg/*.cfg)
if(cfg_files)
  generate_dynamic_reconfigure_options(${cfg_files})
endif()

# Others build on the messages; MRPT and the other libraries of the core stay inside.
catkin_package(CATKIN_DEPENDS message_runtime std_msgs geometry_msgs)

# A library or program of the edge: ROS headers count as the system's, the messages are generated first.
function(lodestar_uses_ros target)
  target_include_directories(${target} SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
  # By property: catkin_add_gtest's targets take the plain signature of target_link_libraries, all others keywords.
  set_property(TARGET ${target} APPEND PROPERTY LINK_LIBRARIES ${catkin_LIBRARIES})
  set_property(TARGET ${target} APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${catkin_LIBRARIES})
  add_dependencies(${target} ${catkin_EXPORTED_TARGETS} ${PROJECT_NAME}_generate_messages_cpp)
  if(TARGET ${PROJECT_NAME}_gencfg)
    add_dependencies(${target} ${PROJECT_NAME}_gencfg)
  endif()
endfunction()

function(lodestar_install_program target)
  install(TARGETS ${target} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

foreach(folder launch config rviz)
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${folder} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  endif()
endforeach()
if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/nodelet_plugins.xml)
  install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
endif()
