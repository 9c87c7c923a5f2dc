# Language, default build type, warnings, sanitizers.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo" FORCE)
endif()

# catkin's Python is the system's, whatever stands first in PATH.
set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that has catkin_pkg")
set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE} CACHE FILEPATH "Python that has catkin_pkg")

set(SANITIZE "" CACHE STRING "Sanitizers to build with, as for -fsanitize (address,undefined)")

add_library(lodestar_options INTERFACE)
target_compile_options(lodestar_options INTERFACE -Wall -Wextra -Wpedantic)
if(WARNINGS_AS_ERRORS)
  target_compile_options(lodestar_options INTERFACE -Werror)
endif()
if(SANITIZE)
  target_compile_options(lodestar_options INTERFACE -fsanitize=${SANITIZE} -fno-omit-frame-pointer)
  target_link_options(lodestar_options INTERFACE -fsanitize=${SANITIZE})
endif()
