#pragma once

#include <string>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

Result<Announcement, MessageDrop> announcement_from(const BeaconAnnouncement& message);

BeaconAnnouncement announcement_message(const Announcement& announcement, const std::string& map_frame);

}  // namespace lodestar
