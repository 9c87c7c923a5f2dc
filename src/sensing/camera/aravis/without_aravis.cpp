#include "../aravis_source.hpp"

namespace lodestar {

std::unique_ptr<FrameSource> open_aravis_source(AravisBus bus, const std::string& address) {
  throw CameraRefusal({{(bus == AravisBus::kGige ? "gige:" : "usb3:") + address, 0,
                        "this build has no Aravis: install libaravis-dev and build with -DLODESTAR_ARAVIS=ON"}});
}

}  // namespace lodestar
