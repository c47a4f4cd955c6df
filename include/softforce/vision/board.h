#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace softforce::vision {

// A flat calibration board: a printed pattern whose feature points have known places.
//
// Every point has an id, counted row by row from the origin, columns first; `Point(id)` is its
// place in the board's own frame, z = 0:
//   chessboard  x right, y down, z away from the viewer, as in OpenCV. Point 0 is the inner corner
//               at the top left. If columns + rows is odd, the square in the top left corner is
//               black and the pattern tells how the board is turned.
//   ChArUco     x right, y down, z away from the viewer, origin at the outer corner of the top left
//               square, as in OpenCV 4.6. The points are the inner corners of the squares.
//   AprilGrid   x right, y up, z towards the viewer, as in Kalibr. Origin at the lower left corner
//               of the lower left tag, which has the lowest id. The points are the corners of the
//               tags, two columns and two rows of them for each of the tags.
//   circles     x right, y down, z away from the viewer, as OpenCV's asymmetric grid: circle j of
//               row i stands at ((2 j + i mod 2) · spacing, i · spacing). The points are the
//               circles' centres.
struct Board {
  enum class Kind { kChessboard, kCharuco, kAprilGrid, kCircles };

  Kind kind = Kind::kChessboard;
  // Chessboard: INNER corners along a row and along a column, one fewer than squares, as in OpenCV.
  // ChArUco: SQUARES, as in OpenCV. AprilGrid: tags. Circles: circles in a row, and rows.
  int columns = 0, rows = 0;
  double square = 0;       // m, side of a square; chessboard and ChArUco
  double marker = 0;       // m, side of an ArUco marker's black square; ChArUco
  std::string dictionary;  // of the markers, as "4X4_50"; ChArUco
  // ChArUco as OpenCV drew it before 4.6: with an even number of rows, the top left square is
  // white.
  bool legacy = false;
  double tag = 0;        // m, side of a tag's black square; AprilGrid
  double gap_ratio = 0;  // gap between two tags over `tag`, Kalibr's tagSpacing; AprilGrid
  std::string family;    // as "tag36h11"; AprilGrid
  int first_tag = 0;     // id of the lower left tag; AprilGrid
  double spacing = 0;    // m, between rows; half of that between neighbours in a row; circles
  double diameter = 0;   // m, of a circle; circles

  void Check() const;  // throws InputError naming the entry

  int NumPoints() const { return point_columns() * point_rows(); }
  Eigen::Vector3d Point(int id) const;          // m
  std::vector<Eigen::Vector3d> Points() const;  // m, by id

  int point_columns() const;  // points in a row
  int point_rows() const;

  // m, the typical distance between neighbouring features: side of a square or of a tag, or the
  // distance of two circles along a diagonal.
  double CellSize() const;

  // Whether the board looks the same after half a turn (or a quarter, if square). Ids are then
  // given as if the board stood upright in the picture: its x axis pointing as far right as it can.
  bool LooksAlikeWhenTurned() const;

  // "chessboard:9x6,square=20mm": what ParseBoard() reads, always spelt in the same way.
  std::string Text() const;
};

// One line for each kind of board: how it is written.
extern const char* const kBoardHelp;

// Reads a board from the command line: a kind, columns x rows, and entries with units; spaces do
// not matter.
//   chessboard:9x6,square=20mm                             9x6 INNER corners (10x7 squares)
//   charuco:7x10,square=20mm,marker=15mm,dictionary=4X4_50[,legacy]         7x10 SQUARES
//   aprilgrid:6x6,tag=24mm,spacing=0.3[,family=tag36h11,first=0]            6x6 tags
//   circles:4x11,spacing=20mm,diameter=14mm                4 circles in each of 11 rows
// Or the path of a .yaml file as Kalibr's targets have it (target_type, tagCols, …). Throws
// InputError, naming `where`, with the fix.
Board ParseBoard(const std::string& text, const std::string& where = "--board");

}  // namespace softforce::vision
