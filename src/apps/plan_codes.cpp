// plan_codes: tones, codes and slots for the beacons of a site.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/evaluation/site_plot.hpp"
#include "lodestar/planning/code_plan.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;

constexpr char kUsage[] =
    "plan_codes - tones, codes and slots for the beacons of a site\n"
    "\n"
    "Usage: plan_codes --fps F --window N --mains 50|60 --waveform sine|square --beacons SITE.yaml\n"
    "                  [--out PLANNED.yaml] [--plot PLAN.png]\n"
    "\n"
    "Examples:\n"
    "  plan_codes --fps 60 --window 30 --mains 50 --waveform sine --beacons survey.yaml --out site.yaml\n"
    "  plan_codes --fps 60 --window 60 --mains 60 --waveform sine --beacons survey.yaml --out site.yaml --plot "
    "site.png\n"
    "  plan_codes --fps 25 --window 15 --mains 50 --waveform square --beacons config/site_paper.yaml\n"
    "\n"
    "SITE.yaml is a site file whose beacons need only id and position_m; codes, slots and tone table that it has are\n"
    "made anew. No two beacons that one camera position sees share a code or a slot. docs/nodes/plan_codes.md has the "
    "rest.\n";

double number(const po::variables_map& options, const std::string& name, double above, double most,
              const std::string& unit) {
  const double value = options[name].as<double>();
  if (value > above && value <= most) return value;
  char text[160];
  std::snprintf(text, sizeof text, "--%s is %g%s, it must be above %g and at most %g.", name.c_str(), value,
                unit.c_str(), above, most);
  throw UserError(text);
}

int whole(const po::variables_map& options, const std::string& name, int least, int most) {
  const int value = options[name].as<int>();
  if (value >= least && value <= most) return value;
  throw UserError("--" + name + " is " + std::to_string(value) + ", it must be from " + std::to_string(least) + " to " +
                  std::to_string(most) + ".");
}

Waveform waveform(const po::variables_map& options) {
  const auto text = options["waveform"].as<std::string>();
  if (text != "sine" && text != "square") throw UserError("--waveform is " + text + ", it must be sine or square.");
  return text == "square" ? Waveform::kSquare : Waveform::kSine;
}

CodePlanParams read_params(const po::variables_map& options) {
  CodePlanParams params;
  params.book.rate_hz = number(options, "fps", 0, 1000, " frames/s");
  params.book.window_frames = whole(options, "window", 5, 300);
  const int mains_hz = options["mains"].as<int>();
  if (mains_hz != 50 && mains_hz != 60)
    throw UserError("--mains is " + std::to_string(mains_hz) + " Hz, it must be 50 or 60.");
  params.book.mains_hz = mains_hz;
  params.book.waveform = waveform(options);
  if (params.book.waveform == Waveform::kSquare) params.book.tones_per_code = {1};
  if (options.count("tones-per-code")) {
    params.book.tones_per_code = {whole(options, "tones-per-code", 1, 3)};
    if (params.book.waveform == Waveform::kSquare && params.book.tones_per_code.front() > 1)
      throw UserError("--tones-per-code is " + std::to_string(params.book.tones_per_code.front()) +
                      ", a square beacon sends one tone: give 1, or --waveform sine.");
  }
  params.book.lowest_tone_hz = number(options, "lowest-tone", 0, 1000, " Hz");
  params.view.camera_height_m = number(options, "camera-height", -1e6, 1e6, " m");
  params.view.angle_rad = radians(number(options, "view-angle", 0, 89, " deg"));
  params.view.range_m = number(options, "range", 0, 1e4, " m");
  if (options.count("slots")) params.slot_count = whole(options, "slots", 1, 256);
  return params;
}

std::string join(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) {
    char text[32];
    std::snprintf(text, sizeof text, "%s%g", out.empty() ? "" : ", ", value);
    out += text;
  }
  return out;
}

std::string reuse(const std::optional<double>& distance_m) {
  char text[64] = "each beacon has its own";
  if (distance_m) std::snprintf(text, sizeof text, "the same again %.1f m away or farther", *distance_m);
  return text;
}

void print(const CodePlan& plan, const CodePlanParams& params) {
  const Link& link = plan.site.link;
  std::printf("beacons    %zu; one camera position sees up to %d, at x %.1f m, y %.1f m\n", plan.site.beacons.size(),
              plan.crowd.beacons, plan.crowd.camera_map.x(), plan.crowd.camera_map.y());
  std::printf("apart      %.1f m where the view is widest: nearer beacons share neither code nor slot\n",
              plan.separation_m);
  std::printf("tones      %s Hz\n", join(plan.book.tone_table_hz).c_str());
  std::printf("codes      %zu, %d of them with %g dB to spare where the camera clips; %d used, %s\n",
              plan.book.codes.size(), plan.book.robust, kReserve_db, plan.codes_used, reuse(plan.code_reuse_m).c_str());
  std::printf("slots      %d, %d used, %s; superframe %g s\n", link.slot_count, plan.slots_used,
              reuse(plan.slot_reuse_m).c_str(), link.slot_count * link.slot_s);
  std::printf("carries    %.4f beacons/m2 by codes, %.4f by slots: one for each %.1f m2\n", plan.code_capacity_per_m2,
              plan.slot_capacity_per_m2, 1 / std::min(plan.code_capacity_per_m2, plan.slot_capacity_per_m2));
  if (plan.book.guard < 3)
    std::printf("note       some tones stand nearer to 0 Hz, lamps or Nyquist than is good: a longer --window helps\n");
  if (window_frames(plan.book.tone_table_hz, params.book.rate_hz) != params.book.window_frames)
    std::printf(
        "note       the tones alone would give a window of %d frames: write `window_frames: %d` under `camera` "
        "into the vehicle file\n",
        window_frames(plan.book.tone_table_hz, params.book.rate_hz), params.book.window_frames);
}

/// The key file as seen from the folder of `out`.
std::string key_file_from(const std::string& key_file, const std::string& survey, const std::string& out) {
  if (key_file.empty() || fs::path(key_file).is_absolute()) return key_file;
  return fs::proximate(fs::absolute(survey).parent_path() / key_file, fs::absolute(out).parent_path()).string();
}

/// The plan as a site file's text that has passed the checks of every site file.
std::string checked_text(const Site& site, const CodePlanParams& params, const std::string& path) {
  char head[256];
  std::snprintf(head, sizeof head, "# Written by plan_codes for %g frames/s, a window of %d frames, %g Hz mains.\n",
                params.book.rate_hz, params.book.window_frames, params.book.mains_hz);
  const std::string text = head + to_yaml(site);
  const Site read = value_or_throw(parse_site(text, path));
  const Faults faults = check_tones(read, {params.book.rate_hz, params.book.mains_hz, params.book.window_frames}, path);
  if (!faults.empty()) throw UserError(describe(faults));
  return text;
}

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw UserError(path + ": cannot be written; choose another --out.");
}

int plan_and_write(const po::variables_map& options) {
  const CodePlanParams params = read_params(options);
  const auto survey_path = options["beacons"].as<std::string>();
  const auto outcome = plan_codes(value_or_throw(load_survey(survey_path)), params);
  if (!outcome) throw UserError(survey_path + ": " + outcome.error());
  CodePlan plan = *outcome;

  const auto out_path = options.count("out") ? options["out"].as<std::string>() : survey_path;
  plan.site.link.key_file = key_file_from(plan.site.link.key_file, survey_path, out_path);
  const std::string text = checked_text(plan.site, params, out_path);
  if (options.count("out")) write(out_path, text);
  print(plan, params);
  if (options.count("plot"))
    plot_site(options["plot"].as<std::string>(), {survey_path, plan.site, plan.crowd.camera_map, plan.view_radius_m});
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("fps", po::value<double>()->required(), "rate of the camera, frames/s")(
      "window", po::value<int>()->required(), "frames of the detector's window")("mains", po::value<int>()->required(),
                                                                                 "what the lamps run on, 50 or 60 Hz")(
      "waveform", po::value<std::string>()->required(), "sine or square")(
      "beacons", po::value<std::string>()->required(), "site file (YAML): where the beacons hang")(
      "out", po::value<std::string>(), "write the complete site file here")("plot", po::value<std::string>(),
                                                                            "draw the codes over the floor, PNG")(
      "camera-height", po::value<double>()->default_value(2), "z of the lowest camera in map, m")(
      "view-angle", po::value<double>()->default_value(70), "how far off its axis the camera sees beacons, deg")(
      "range", po::value<double>()->default_value(25), "how far the camera sees beacons, m")(
      "slots", po::value<int>(), "slots of a superframe (default: the site file's, or as many more as it takes)")(
      "tones-per-code", po::value<int>(), "1 to 3 (default: square 1; sine 2, and 3 where pairs are too few)")(
      "lowest-tone", po::value<double>()->default_value(4), "warning lights flash below this, Hz");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::plan_and_write);
}
