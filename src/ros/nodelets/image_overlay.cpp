#include "lodestar/ros/nodelets/image_overlay.hpp"

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

constexpr int kRing_px = 11;
constexpr double kGain = 3;  // exposures are short: what is faint shall be seen

std::string tones(const BeaconSighting& sighting) {
  std::string out;
  for (const double tone_hz : sighting.tones_hz) {
    char text[16];
    std::snprintf(text, sizeof text, "%s%g", out.empty() ? "" : "+", tone_hz);
    out += text;
  }
  return out + " Hz";
}

cv::Mat in_colour(const Image& image) {
  // The pixels are only read; OpenCV has no view of constant data.
  const cv::Mat raw(image.height_px, image.width_px, image.bits == 8 ? CV_8UC1 : CV_16UC1,
                    const_cast<std::uint8_t*>(image.data), image.stride_bytes);
  cv::Mat grey, bgr;
  raw.convertTo(grey, CV_8U, image.bits == 8 ? kGain : kGain / 256);
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

}  // namespace

sensor_msgs::ImagePtr draw_sightings(const Image& image, const BeaconSightingArray& sightings) {
  cv::Mat bgr = in_colour(image);
  for (const BeaconSighting& sighting : sightings.sightings) {
    if (!std::isfinite(sighting.u_px) || !std::isfinite(sighting.v_px)) continue;
    const cv::Scalar paint = sighting.named ? cv::Scalar(90, 255, 60) : cv::Scalar(0, 190, 255);
    const cv::Point centre(cvRound(sighting.u_px), cvRound(sighting.v_px));
    cv::circle(bgr, centre, kRing_px, paint, 2, cv::LINE_AA);
    const std::string text = sighting.named ? std::to_string(sighting.beacon_id) : tones(sighting);
    cv::putText(bgr, text, centre + cv::Point(kRing_px + 3, 5), cv::FONT_HERSHEY_SIMPLEX, 0.6, paint, 2, cv::LINE_AA);
  }
  auto out = boost::make_shared<sensor_msgs::Image>();
  out->header.stamp = ros_time(image.stamp);
  out->header.frame_id = sightings.header.frame_id;
  out->encoding = "bgr8";
  out->width = static_cast<std::uint32_t>(bgr.cols);
  out->height = static_cast<std::uint32_t>(bgr.rows);
  out->step = static_cast<std::uint32_t>(bgr.cols * 3);
  out->data.assign(bgr.datastart, bgr.dataend);
  return out;
}

}  // namespace lodestar
