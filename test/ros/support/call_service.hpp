#pragma once

#include <ros/ros.h>

#include <string>

namespace lodestar::test {

/// Asks over a connection that stays until the answer is read. After a single call the server hangs up, and on a busy
/// machine roscpp may see that before the answer, which then counts as none.
template <class Service>
bool call_service(const std::string& name, Service& service) {
  ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(name, true);
  return client.call(service);
}

}  // namespace lodestar::test
