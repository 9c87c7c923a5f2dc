#include "../aravis_source.hpp"

#include <arv.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <vector>

#include "lodestar/sensing/camera/answer_watch.hpp"

namespace lodestar {
namespace {

constexpr int kBuffers = 8;

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
template <class Object>
using Reference = std::unique_ptr<Object, Unref>;

struct Format {
  const char* name;
  const char* genicam;
  ArvPixelFormat code;
  int bits;
};
/// The first of a name that the camera has counts. 10 and 12 bits come in 16, the low ones.
constexpr Format kFormats[] = {{"mono8", "Mono8", ARV_PIXEL_FORMAT_MONO_8, 8},
                               {"mono16", "Mono16", ARV_PIXEL_FORMAT_MONO_16, 16},
                               {"mono16", "Mono12", ARV_PIXEL_FORMAT_MONO_12, 16},
                               {"mono16", "Mono10", ARV_PIXEL_FORMAT_MONO_10, 16}};

void delete_owner(void* owner) { delete static_cast<std::shared_ptr<void>*>(owner); }

/// Comes from a thread of Aravis', which asks the camera again and again.
void note_lost(ArvDevice*, std::atomic<bool>* lost) { *lost = true; }

class AravisSource : public FrameSource {
 public:
  AravisSource(std::string name, Reference<ArvCamera> camera) : name_(std::move(name)), camera_(std::move(camera)) {
    g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost", G_CALLBACK(note_lost), &lost_);
  }

  SourceInfo start(const CameraSettings& settings, const FrameAllocator& allocate) override;
  Result<DeviceFrame, NoFrame> next(Duration timeout) override;

 private:
  /// Calls one of Aravis' functions, whose last argument is a GError**.
  template <class Function, class... Arguments>
  auto call(Function function, Arguments... arguments) {
    GError* error = nullptr;
    struct Check {
      const AravisSource& source;
      GError*& error;
      void operator()() const {
        if (!error) return;
        const std::string what = source.name_ + ": " + error->message;
        g_clear_error(&error);
        throw CameraError(what);
      }
    } check{*this, error};
    if constexpr (std::is_void_v<decltype(function(camera_.get(), arguments..., &error))>) {
      function(camera_.get(), arguments..., &error);
      check();
    } else {
      const auto result = function(camera_.get(), arguments..., &error);
      check();
      return result;
    }
  }
  template <class Function>
  std::vector<std::string> names(Function function);

  CameraLimits limits();
  void set_format(const CameraSettings& settings);
  template <class Available, class Set, class Get>
  void stop(const char* automatic, Available available, Set set, Get get);
  void make_manual();
  void refuse_beyond_limits(const CameraSettings& settings);
  void apply(const CameraSettings& settings);
  SourceInfo info(const CameraSettings& settings);
  void start_stream();
  void push_new_buffer();
  Result<DeviceFrame, NoFrame> frame_of(ArvBuffer& buffer) const;

  std::string name_;
  std::atomic<bool> lost_{false};  // goes after the camera, whose thread writes it
  Reference<ArvCamera> camera_;
  Reference<ArvStream> stream_;                                           // goes before the camera
  AnswerWatch answers_{[device = arv_camera_get_device(camera_.get())] {  // likewise
    guint32 version = 0;
    return arv_device_read_register(device, 0, &version, nullptr) != FALSE;
  }};
  FrameAllocator allocate_;
  Format format_ = kFormats[0];
  std::size_t payload_bytes_ = 0;
};

template <class Function>
std::vector<std::string> AravisSource::names(Function function) {
  guint count = 0;
  const char** const list = call(function, &count);
  std::vector<std::string> names(list, list + count);
  g_free(list);
  return names;
}

CameraLimits AravisSource::limits() {
  CameraLimits limits;
  double lowest = 0, highest = 0;
  if (call(arv_camera_is_exposure_time_available)) {
    call(arv_camera_get_exposure_time_bounds, &lowest, &highest);
    limits.exposure_s = SettingRange{lowest * 1e-6, highest * 1e-6};
  }
  if (call(arv_camera_is_gain_available)) {
    call(arv_camera_get_gain_bounds, &lowest, &highest);
    limits.gain = SettingRange{lowest, highest};
  }
  if (call(arv_camera_is_frame_rate_available)) {
    call(arv_camera_get_frame_rate_bounds, &lowest, &highest);
    limits.rate_hz = SettingRange{lowest, highest};
  }
  gint least = 0, most = 0;
  call(arv_camera_get_width_bounds, &least, &most);
  limits.width_px = SettingRange{static_cast<double>(least), static_cast<double>(most)};
  call(arv_camera_get_height_bounds, &least, &most);
  limits.height_px = SettingRange{static_cast<double>(least), static_cast<double>(most)};

  const auto offered = names(arv_camera_dup_available_pixel_formats_as_strings);
  for (const Format& format : kFormats) {
    const bool has = std::find(offered.begin(), offered.end(), format.genicam) != offered.end();
    const bool known = !limits.pixel_formats.empty() && limits.pixel_formats.back() == format.name;
    if (has && !known) limits.pixel_formats.emplace_back(format.name);
  }
  if (call(arv_camera_is_feature_available, "TriggerSource"))
    limits.triggers = names(arv_camera_dup_available_trigger_sources);
  return limits;
}

void AravisSource::set_format(const CameraSettings& settings) {
  const auto offered = names(arv_camera_dup_available_pixel_formats_as_strings);
  format_ = *std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& format) {
    return (settings.pixel_format.empty() || settings.pixel_format == format.name) &&
           std::find(offered.begin(), offered.end(), format.genicam) != offered.end();
  });
  call(arv_camera_set_pixel_format, format_.code);
  gint x = 0, y = 0, width = 0, height = 0;
  call(arv_camera_get_region, &x, &y, &width, &height);
  if (settings.width_px || settings.height_px)
    call(arv_camera_set_region, x, y, settings.width_px.value_or(width), settings.height_px.value_or(height));
}

template <class Available, class Set, class Get>
void AravisSource::stop(const char* automatic, Available available, Set set, Get get) {
  if (!call(available)) return;
  GError* error = nullptr;
  set(camera_.get(), ARV_AUTO_OFF, &error);
  g_clear_error(&error);  // it is asked whether it did; one that is gone does not answer
  if (call(get) != ARV_AUTO_OFF) throw CameraRefusal({{name_, 0, std::string(automatic) + " stays automatic"}});
}

void AravisSource::make_manual() {
  stop("exposure", arv_camera_is_exposure_auto_available, arv_camera_set_exposure_time_auto,
       arv_camera_get_exposure_time_auto);
  stop("gain", arv_camera_is_gain_auto_available, arv_camera_set_gain_auto, arv_camera_get_gain_auto);
  stop("black level", arv_camera_is_black_level_auto_available, arv_camera_set_black_level_auto,
       arv_camera_get_black_level_auto);
}

void AravisSource::refuse_beyond_limits(const CameraSettings& settings) {
  const Faults faults = check_settings(settings, limits(), name_);
  if (!faults.empty()) throw CameraRefusal(faults);
}

// The ranges of exposure and rate depend on one another: first the exposure without a rate, then the rate.
void AravisSource::apply(const CameraSettings& settings) {
  call(arv_camera_set_acquisition_mode, ARV_ACQUISITION_MODE_CONTINUOUS);
  call(arv_camera_clear_triggers);
  if (call(arv_camera_is_feature_available, "AcquisitionFrameRateEnable"))
    call(arv_camera_set_boolean, "AcquisitionFrameRateEnable", FALSE);
  CameraSettings without_rate = settings;
  without_rate.rate_hz.reset();
  refuse_beyond_limits(without_rate);
  set_format(settings);
  if (settings.exposure_s) call(arv_camera_set_exposure_time, *settings.exposure_s * 1e6);
  if (settings.gain) call(arv_camera_set_gain, *settings.gain);
  refuse_beyond_limits(settings);
  if (settings.rate_hz) call(arv_camera_set_frame_rate, *settings.rate_hz);
  if (!settings.trigger.empty()) call(arv_camera_set_trigger, settings.trigger.c_str());
}

SourceInfo AravisSource::info(const CameraSettings& settings) {
  const std::string vendor = call(arv_camera_get_vendor_name), model = call(arv_camera_get_model_name);
  GError* error = nullptr;
  const char* const serial = arv_camera_get_device_serial_number(camera_.get(), &error);
  const std::string number = serial && !error ? serial : "";  // some have none
  g_clear_error(&error);

  SourceInfo info;
  info.name = name_ + " " + vendor + " " + model + (number.empty() ? "" : " " + number);
  info.triggered = !settings.trigger.empty();
  info.in_place = true;
  if (call(arv_camera_is_exposure_time_available)) info.exposure_s = call(arv_camera_get_exposure_time) * 1e-6;
  const double rate_hz = call(arv_camera_is_frame_rate_available) ? call(arv_camera_get_frame_rate) : 0;
  if (rate_hz > 0) info.period_s = 1 / rate_hz;
  const bool wide_ids = arv_camera_is_uv_device(camera_.get()) ||
                        (call(arv_camera_is_feature_available, "GevGVSPExtendedIDMode") &&
                         std::string(call(arv_camera_get_string, "GevGVSPExtendedIDMode")) == "On");
  info.clock.frame_id_bits = wide_ids ? 64 : 16;
  return info;
}

SourceInfo AravisSource::start(const CameraSettings& settings, const FrameAllocator& allocate) {
  allocate_ = allocate;
  call(arv_camera_stop_acquisition);
  if (limits().pixel_formats.empty()) throw CameraRefusal({{name_, 0, "it has neither mono8 nor mono16"}});
  make_manual();
  apply(settings);
  const SourceInfo started = info(settings);
  start_stream();
  return started;
}

void AravisSource::start_stream() {
  payload_bytes_ = call(arv_camera_get_payload);
  stream_.reset(call(arv_camera_create_stream, nullptr, nullptr));
  for (int i = 0; i < kBuffers; ++i) push_new_buffer();
  call(arv_camera_start_acquisition);
}

void AravisSource::push_new_buffer() {
  FrameMemory memory = allocate_(payload_bytes_);
  arv_stream_push_buffer(stream_.get(), arv_buffer_new_full(payload_bytes_, memory.data,
                                                            new std::shared_ptr<void>(memory.owner), delete_owner));
}

Result<DeviceFrame, NoFrame> AravisSource::next(Duration timeout) {
  const auto timeout_us = std::chrono::duration_cast<std::chrono::microseconds>(timeout).count();
  const Reference<ArvBuffer> buffer(
      arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(std::max<std::int64_t>(timeout_us, 0))));
  if (!buffer) {
    // Aravis itself gives up after 2.5 s of asking only.
    if (lost_ || !answers_.alive(std::chrono::steady_clock::now()))
      throw CameraError(name_ + " does not answer any more");
    return NoFrame::kTimeout;
  }
  push_new_buffer();
  return frame_of(*buffer);
}

Result<DeviceFrame, NoFrame> AravisSource::frame_of(ArvBuffer& buffer) const {
  if (arv_buffer_get_status(&buffer) != ARV_BUFFER_STATUS_SUCCESS) return NoFrame::kIncomplete;
  if (arv_buffer_get_payload_type(&buffer) != ARV_BUFFER_PAYLOAD_TYPE_IMAGE) return NoFrame::kFormat;
  if (arv_buffer_get_image_pixel_format(&buffer) != format_.code) return NoFrame::kFormat;
  std::size_t bytes = 0;
  const auto* const data = static_cast<const std::uint8_t*>(arv_buffer_get_image_data(&buffer, &bytes));

  DeviceFrame frame;
  frame.width_px = arv_buffer_get_image_width(&buffer);
  frame.height_px = arv_buffer_get_image_height(&buffer);
  frame.bits = format_.bits;
  frame.stride_bytes = static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.bits / 8);
  if (bytes < frame.stride_bytes * static_cast<std::size_t>(frame.height_px)) return NoFrame::kFormat;
  frame.memory.data = const_cast<std::uint8_t*>(data);  // it is ours: push_new_buffer() gave it
  frame.memory.owner = *static_cast<const std::shared_ptr<void>*>(arv_buffer_get_user_data(&buffer));
  frame.id = arv_buffer_get_frame_id(&buffer);
  frame.ticks = arv_buffer_get_timestamp(&buffer);
  frame.heard = {frame.ticks, Stamp(Duration(static_cast<std::int64_t>(arv_buffer_get_system_timestamp(&buffer))))};
  return frame;
}

bool is_serial_number_of(unsigned int device, const std::string& number) {
  const char* const serial = arv_get_device_serial_nbr(device);
  return serial != nullptr && number == serial;
}

/// What Aravis is to open, empty: nothing. A name is looked up in its list, which knows the way there as well; without
/// it Aravis may take another network interface. An address says both.
std::string camera_of(AravisBus bus, const std::string& address) {
  if (g_hostname_is_ip_address(address.c_str())) return address;
  const std::string protocol = bus == AravisBus::kGige ? "GigEVision" : "USB3Vision";
  arv_update_device_list();
  for (unsigned int i = 0; i < arv_get_n_devices(); ++i) {
    if (protocol != arv_get_device_protocol(i)) continue;
    if (address.empty() || is_serial_number_of(i, address)) return arv_get_device_id(i);
  }
  return address;
}

}  // namespace

std::unique_ptr<FrameSource> open_aravis_source(AravisBus bus, const std::string& address) {
  const std::string name = (bus == AravisBus::kGige ? "gige:" : "usb3:") + address;
  const std::string id = camera_of(bus, address);
  if (id.empty()) throw CameraError(name + " no such camera was found");
  GError* error = nullptr;
  Reference<ArvCamera> camera(arv_camera_new(id.c_str(), &error));
  if (error) {
    const std::string what = name + ": " + error->message;
    g_clear_error(&error);
    throw CameraError(what);
  }
  const bool is_gige = arv_camera_is_gv_device(camera.get());
  if (is_gige != (bus == AravisBus::kGige))
    throw CameraRefusal(
        {{name, 0, "it is not on that bus: write " + std::string(is_gige ? "gige:" : "usb3:") + address}});
  return std::make_unique<AravisSource>(name, std::move(camera));
}

}  // namespace lodestar
