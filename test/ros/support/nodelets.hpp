#pragma once

#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/ros.h>

#include <string>

#include "call_service.hpp"

namespace lodestar::test {

/// Starts a nodelet in a manager that runs, or may soon. False: it refused.
inline bool load_nodelet(const std::string& name, const std::string& type, const std::string& manager = "manager") {
  nodelet::NodeletLoad load;
  load.request.name = "/" + name;
  load.request.type = type;
  const std::string service = "/" + manager + "/load_nodelet";
  return ros::service::waitForService(service, ros::Duration(60)) && call_service(service, load) &&
         load.response.success;
}

inline bool unload_nodelet(const std::string& name, const std::string& manager = "manager") {
  nodelet::NodeletUnload unload;
  unload.request.name = "/" + name;
  return call_service("/" + manager + "/unload_nodelet", unload) && unload.response.success;
}

}  // namespace lodestar::test
