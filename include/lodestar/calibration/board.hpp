#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

/// A flat board with marks at known places.
struct Board {
  enum class Kind {
    kChessboard,  ///< marks: inner corners
    kCharuco,     ///< marks: inner corners of the chessboard that holds the markers
    kAprilgrid    ///< marks: four corners of each tag, Kalibr's layout: ids row by row from the lower left
  };
  Kind kind = Kind::kChessboard;
  int columns = 0, rows = 0;  ///< squares (chessboard, ChArUco) or tags (AprilGrid)
  double square_m = 0;        ///< side of a square, or of a tag
  double marker_m = 0;        ///< ChArUco: side of a marker; AprilGrid: gap between two tags
};

/// A mark of the board and where it was seen.
struct BoardPoint {
  Eigen::Vector2d board_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};
using BoardView = std::vector<BoardPoint>;

/// What is wrong with a board's dimensions; empty: nothing.
std::string fault_of(const Board& board);

/// The board's marks in an image; none where it is not seen (chessboard: not whole), or its marks there lie in a line.
/// The families of markers are OpenCV's 6x6_250 for ChArUco and AprilTag 36h11 with Kalibr's border of two cells for
/// AprilGrid.
std::optional<BoardView> find_board(const Image& image, const Board& board);

}  // namespace lodestar
