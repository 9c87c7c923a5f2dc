// calibrate: a camera's lens from views of a board.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <string>
#include <variant>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/calibration/lens_calibration.hpp"
#include "lodestar/evaluation/lens_plot.hpp"
#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;

constexpr char kUsage[] =
    "calibrate - the lens of a camera from views of a board, as a camera_info file for the equidistant model\n"
    "\n"
    "Usage: calibrate --images FOLDER|IN.bag --board chessboard|charuco|aprilgrid --size COLUMNSxROWS --square-m S\n"
    "                 [--marker-m M] [--out camera.yaml] [--plot coverage.png]\n"
    "\n"
    "Examples:\n"
    "  calibrate --images shots/ --board chessboard --size 10x8 --square-m 0.03 --out camera.yaml --plot coverage.png\n"
    "  calibrate --images board.bag --board charuco --size 8x6 --square-m 0.04 --marker-m 0.03 --out camera.yaml\n"
    "  calibrate --images board.bag --board aprilgrid --size 6x6 --square-m 0.088 --marker-m 0.0264 --out camera.yaml\n"
    "\n"
    "The size counts squares (AprilGrid: tags). Show the board tilted, near, and in every corner of the image, 30 "
    "times or\n"
    "more. docs/nodes/calibrate.md has the rest.\n";

Board read_board(const po::variables_map& options) {
  const auto kind = options["board"].as<std::string>();
  Board board;
  if (kind == "charuco") board.kind = Board::Kind::kCharuco;
  if (kind == "aprilgrid") board.kind = Board::Kind::kAprilgrid;
  if (kind != "charuco" && kind != "aprilgrid" && kind != "chessboard")
    throw UserError("--board is " + kind + ", it must be chessboard, charuco or aprilgrid.");
  const auto size = options["size"].as<std::string>();
  char end = 0;
  if (std::sscanf(size.c_str(), "%dx%d%c", &board.columns, &board.rows, &end) != 2)
    throw UserError("--size is " + size + ", it must be COLUMNSxROWS, such as 10x8.");
  board.square_m = options["square-m"].as<double>();
  board.marker_m = options["marker-m"].as<double>();
  const std::string fault = fault_of(board);
  if (!fault.empty()) throw UserError(fault + ": see --size, --square-m and --marker-m.");
  return board;
}

/// What is to be looked at: each image's name and pixels, one after the other.
using Look = std::function<void(const std::string& name, const Image& image)>;

void each_file(const std::string& folder, const Look& look) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (cv::haveImageReader(entry.path())) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  ProgressBar bar("calibrate");
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const cv::Mat pixels = cv::imread(paths[i], cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
    if (pixels.empty()) throw UserError(paths[i].string() + ": is no image that can be read.");
    if (pixels.depth() != CV_8U && pixels.depth() != CV_16U)
      throw UserError(paths[i].string() + ": has neither 8 nor 16 bits a pixel.");
    Image image;
    image.width_px = pixels.cols;
    image.height_px = pixels.rows;
    image.bits = pixels.depth() == CV_8U ? 8 : 16;
    image.stride_bytes = pixels.step;
    image.data = pixels.data;
    look(paths[i].filename(), image);
    bar.show(static_cast<double>(i + 1) / static_cast<double>(paths.size()));
  }
}

void each_in_bag(const std::string& path, double step_s, const Look& look) {
  RecordingReader reader(path);
  ProgressBar bar("calibrate");
  std::optional<Stamp> last;
  while (const auto record = reader.next()) {
    bar.show(reader.progress());
    const auto* image = std::get_if<Image>(&record->content);
    if (image == nullptr || (last && seconds(image->stamp - *last) < step_s)) continue;
    last = image->stamp;
    look(std::to_string(seconds(image->stamp - reader.begin())) + " s", *image);
  }
}

struct Views {
  std::vector<BoardView> views;
  std::vector<std::string> names;
  int images = 0, width_px = 0, height_px = 0;
};

Views find_views(const po::variables_map& options, const Board& board) {
  Views found;
  const Look look = [&](const std::string& name, const Image& image) {
    if (found.images++ == 0) {
      found.width_px = image.width_px;
      found.height_px = image.height_px;
    }
    if (image.width_px != found.width_px || image.height_px != found.height_px)
      throw UserError(name + " is of another size than the images before: calibrate one camera in one mode.");
    const auto view = find_board(image, board);
    if (!view) return;
    found.views.push_back(*view);
    found.names.push_back(name);
  };
  const auto source = options["images"].as<std::string>();
  if (fs::is_directory(source)) {
    each_file(source, look);
  } else {
    each_in_bag(source, options["step-s"].as<double>(), look);
  }
  if (found.images == 0) throw UserError(source + ": holds no image.");
  return found;
}

/// What the lens must be known to; one sigma above it is warned of.
constexpr double kFocalLimit = 0.0005;  // of the focal length
constexpr double kCentreLimit_px = 0.1;

void print(const Views& found, const LensCalibration& lens, const Coverage& seen) {
  const CameraIntrinsics& k = lens.intrinsics;
  std::printf("board      in %zu of %d images, %zu marks; %d left out as outliers\n", found.views.size(), found.images,
              lens.marks.size(), lens.outliers);
  std::printf("focal      %.3f x %.3f px, one sigma %.3f px\n", k.fx_px, k.fy_px, lens.focal_sigma_px);
  std::printf("centre     %.3f, %.3f px, one sigma %.3f px\n", k.cx_px, k.cy_px, lens.centre_sigma_px);
  std::printf("distortion %.6f %.6f %.6f %.6f\n", k.coefficients[0], k.coefficients[1], k.coefficients[2],
              k.coefficients[3]);
  std::printf("residuals  %.3f px rms\n", lens.rms_px);
  for (std::size_t i = 0; i < found.names.size(); ++i)
    if (lens.view_rms_px[i] > 2 * lens.rms_px)
      std::printf("look at    %s: %.3f px rms; blurred, or the board bends?\n", found.names[i].c_str(),
                  lens.view_rms_px[i]);
  std::printf("coverage   %.0f %% of the image\n", 100 * seen.covered);
  for (const std::string& corner : seen.empty_corners)
    std::printf("warning    no view in the %s corner of the image: the lens is a guess there\n", corner.c_str());
  if (lens.focal_sigma_px > kFocalLimit * std::min(k.fx_px, k.fy_px))
    std::printf(
        "warning    focal: one sigma is %.3f px, above the limit of %.2f %%: add views, tilted ones above all\n",
        lens.focal_sigma_px, 100 * kFocalLimit);
  if (lens.centre_sigma_px > kCentreLimit_px)
    std::printf("warning    centre: one sigma is %.3f px, above the limit of %.1f px: add views\n",
                lens.centre_sigma_px, kCentreLimit_px);
}

int calibrate(const po::variables_map& options) {
  const Board board = read_board(options);
  const auto name = options["name"].as<std::string>();
  if (!std::regex_match(name, std::regex("[A-Za-z0-9_]+")))
    throw UserError("--name: is '" + name +
                    "', must be letters, digits and _ (camera_info_manager knows the camera by it).");
  const Views found = find_views(options, board);
  const auto lens = calibrate_lens(found.views, found.width_px, found.height_px);
  if (!lens) throw UserError(options["images"].as<std::string>() + ": " + lens.error() + ".");
  print(found, *lens, coverage(found.views, found.width_px, found.height_px));

  const auto out = options["out"].as<std::string>();
  std::ofstream file(out);
  file << camera_info_yaml(lens->intrinsics, name);
  file.close();
  if (!file) throw UserError(out + ": cannot be written; choose another --out.");
  if (options.count("plot")) {
    LensPlot plot{out, found.width_px, found.height_px, {}};
    for (const MarkResidual& mark : lens->marks) plot.marks.push_back({mark.pixel, mark.residual_px});
    plot_lens(options["plot"].as<std::string>(), plot);
  }
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("images", po::value<std::string>()->required(),
                        "folder of images, or a bag with /camera/image_raw")(
      "board", po::value<std::string>()->required(), "chessboard, charuco (6x6_250) or aprilgrid (36h11)")(
      "size", po::value<std::string>()->required(), "COLUMNSxROWS of squares, or of tags")(
      "square-m", po::value<double>()->required(), "side of a square, or of a tag, m")(
      "marker-m", po::value<double>()->default_value(0), "side of a ChArUco marker, or gap between two tags, m")(
      "step-s", po::value<double>()->default_value(0.5), "least time between two images of a bag, s")(
      "name", po::value<std::string>()->default_value("camera"), "camera_name in the file")(
      "out", po::value<std::string>()->default_value("camera.yaml"), "camera_info file (YAML)")(
      "plot", po::value<std::string>(), "marks and residuals over the image, PNG");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::calibrate);
}
