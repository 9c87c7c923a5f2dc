# GigE Vision and USB3 Vision cameras by Aravis 0.8; Ubuntu 20.04 has 0.6, and there the trucks' cameras are v4l2.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(ARAVIS QUIET IMPORTED_TARGET aravis-0.8)
endif()
option(LODESTAR_ARAVIS "GigE Vision and USB3 Vision cameras, by Aravis 0.8" ${ARAVIS_FOUND})
if(NOT LODESTAR_ARAVIS)
  message(STATUS "Built without gige: and usb3: cameras, which need Aravis 0.8")
  target_sources(lodestar_camera PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src/sensing/camera/aravis/without_aravis.cpp)
  return()
endif()

target_sources(lodestar_camera PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src/sensing/camera/aravis/aravis_source.cpp)
target_link_libraries(lodestar_camera PRIVATE PkgConfig::ARAVIS)
