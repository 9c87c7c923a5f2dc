#include "lodestar/calibration/board.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace lodestar {
namespace {

constexpr std::size_t kFewestPoints = 8;
constexpr double kWindow = 0.45;  // of the space that a mark has to itself
constexpr int kSmallestWindow_px = 2, kLargestWindow_px = 8;

cv::Mat grey8(const Image& image) {
  const cv::Mat raw(image.height_px, image.width_px, image.bits == 8 ? CV_8UC1 : CV_16UC1,
                    const_cast<std::uint8_t*>(image.data), image.stride_bytes);
  if (image.bits == 8) return raw;
  cv::Mat grey;
  cv::normalize(raw, grey, 0, 255, cv::NORM_MINMAX, CV_8U);
  return grey;
}

Eigen::Vector2d eigen(const cv::Point2f& point) { return {point.x, point.y}; }

BoardView chessboard(const cv::Mat& image, const Board& board) {
  const cv::Size inner(board.columns - 1, board.rows - 1);
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(image, inner, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  BoardView view;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto row = i / static_cast<std::size_t>(inner.width), column = i % static_cast<std::size_t>(inner.width);
    view.push_back({board.square_m * Eigen::Vector2d(column, row), eigen(corners[i])});
  }
  return view;
}

struct Markers {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
};

Markers find_markers(const cv::Mat& image, const cv::Ptr<cv::aruco::Dictionary>& dictionary, int border_bits) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->markerBorderBits = border_bits;
  parameters->minMarkerPerimeterRate = 0.02;
  Markers markers;
  cv::aruco::detectMarkers(image, dictionary, markers.corners, markers.ids, parameters);
  return markers;
}

BoardView charuco(const cv::Mat& image, const Board& board) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250);
  const auto layout = cv::aruco::CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.square_m),
                                                      static_cast<float>(board.marker_m), dictionary);
  const Markers markers = find_markers(image, dictionary, 1);
  if (markers.ids.empty()) return {};
  std::vector<cv::Point2f> corners;
  std::vector<int> ids;
  cv::aruco::interpolateCornersCharuco(markers.corners, markers.ids, image, layout, corners, ids);
  BoardView view;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const cv::Point3f place = layout->chessboardCorners[static_cast<std::size_t>(ids[i])];
    view.push_back({Eigen::Vector2d(place.x, place.y), eigen(corners[i])});
  }
  return view;
}

BoardView aprilgrid(const cv::Mat& image, const Board& board) {
  const Markers tags = find_markers(image, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11), 2);
  BoardView view;
  for (std::size_t i = 0; i < tags.ids.size(); ++i) {
    if (tags.ids[i] >= board.columns * board.rows) continue;
    const Eigen::Vector2d lower_left =
        (board.square_m + board.marker_m) * Eigen::Vector2d(tags.ids[i] % board.columns, tags.ids[i] / board.columns);
    // Clockwise from the upper left, as OpenCV lists them; the board's y points up.
    const Eigen::Vector2d corners[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (std::size_t corner = 0; corner < 4; ++corner)
      view.push_back({lower_left + board.square_m * corners[corner], eigen(tags.corners[i][corner])});
  }
  return view;
}

/// Around a mark no other edge crosses within half of this, on the board.
double free_space_m(const Board& board) {
  switch (board.kind) {
    case Board::Kind::kChessboard:
      return board.square_m;
    case Board::Kind::kCharuco:
      return board.square_m - board.marker_m;
    default:
      return board.marker_m;
  }
}

/// Each mark is where four fields meet, and its centre the point that all gradients around it are square to. The window
/// follows the scale of the image there, by the nearest other mark. A mark that moves out of its window is none.
BoardView refined(const cv::Mat& image, const Board& board, const BoardView& coarse) {
  const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 0.001);
  BoardView view;
  for (const BoardPoint& point : coarse) {
    double scale_px_m = 1e9;
    for (const BoardPoint& other : coarse) {
      const double apart_m = (other.board_m - point.board_m).norm();
      if (apart_m > 0 && apart_m < 1.5 * board.square_m)
        scale_px_m = std::min(scale_px_m, (other.pixel - point.pixel).norm() / apart_m);
    }
    const int half_px = std::min(static_cast<int>(kWindow * free_space_m(board) * scale_px_m), kLargestWindow_px);
    if (half_px < kSmallestWindow_px || scale_px_m > 1e8) continue;
    std::vector<cv::Point2f> centre = {{static_cast<float>(point.pixel.x()), static_cast<float>(point.pixel.y())}};
    cv::cornerSubPix(image, centre, cv::Size(half_px, half_px), cv::Size(-1, -1), until);
    const Eigen::Vector2d moved = eigen(centre.front()) - point.pixel;
    if (moved.norm() < half_px) view.push_back({point.board_m, eigen(centre.front())});
  }
  return view;
}

/// Such marks leave the board's turn about their line open.
bool in_a_line(const BoardView& view) {
  constexpr double kLeastWidth = 1e-3;  // of the length
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  for (const BoardPoint& point : view) centre_m += point.board_m / static_cast<double>(view.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const BoardPoint& point : view) scatter += (point.board_m - centre_m) * (point.board_m - centre_m).transpose();
  const Eigen::Vector2d squares = scatter.selfadjointView<Eigen::Lower>().eigenvalues();
  return squares[0] < kLeastWidth * kLeastWidth * squares[1];
}

}  // namespace

std::string fault_of(const Board& board) {
  const bool grid = board.kind == Board::Kind::kAprilgrid;
  const int least = grid ? 1 : 3;
  if (board.columns < least || board.rows < least || board.columns > 100 || board.rows > 100)
    return "the board has " + std::to_string(board.columns) + " x " + std::to_string(board.rows) + ", it must have " +
           std::to_string(least) + " to 100 each way";
  if (!(board.square_m > 0)) return "the side of a " + std::string(grid ? "tag" : "square") + " must be above 0 m";
  if (board.kind == Board::Kind::kCharuco && !(board.marker_m > 0 && board.marker_m < board.square_m))
    return "a ChArUco board's markers must be smaller than its squares, and above 0 m";
  if (grid && !(board.marker_m > 0)) return "the gap between two tags must be above 0 m";
  return "";
}

std::optional<BoardView> find_board(const Image& image, const Board& board) {
  const cv::Mat grey = grey8(image);
  const BoardView coarse = board.kind == Board::Kind::kChessboard ? chessboard(grey, board)
                           : board.kind == Board::Kind::kCharuco  ? charuco(grey, board)
                                                                  : aprilgrid(grey, board);
  const BoardView view = refined(grey, board, coarse);
  if (view.size() < kFewestPoints || in_a_line(view)) return std::nullopt;
  return view;
}

}  // namespace lodestar
