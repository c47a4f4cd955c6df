#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "softforce/report/run_columns.h"

namespace softforce::report {

// Something a person should know of a run, and what may be done about it.
struct RunAdvice {
  std::string finding, what_to_do;
};

struct StageRow {
  std::string stage;
  double median_ms = 0, p95_ms = 0, max_ms = 0;
};

// A picture of one frame with everything drawn over it.
struct KeyPicture {
  std::string caption;
  std::string jpeg;  // bytes of the file
};

struct ViewForce {
  std::string name;
  Eigen::Vector3f position, force;  // m, N
  float sd = 0;                     // N, standard deviation of the norm
};

struct ViewMarker {
  int id = -1;
  int status = 0;            // index into RunRecord::marker_statuses
  Eigen::Vector3f position;  // m; measured, or where the model has it
};

// The body in one frame; robot frame.
struct BodyView {
  int frame = -1;
  double time_s = NAN;
  std::string label;   // why the frame was chosen; empty: one of many
  Eigen::Matrix3Xf u;  // m, displacements of the nodes of BodyShape
  std::vector<ViewForce> forces;
  std::vector<ViewMarker> markers;
  std::vector<std::vector<Eigen::Vector3f>> cables;  // m, points of each
};

// The body's surface at rest.
struct BodyShape {
  Eigen::Matrix3Xf nodes;      // m
  Eigen::Matrix3Xi triangles;  // flat ones, counter-clockwise seen from outside
};

// All that a run's report shows. Its size does not grow with the number of frames.
struct RunRecord {
  std::string scene;
  bool usable = false;
  std::string brief;  // one line
  std::vector<std::string> warnings;
  std::vector<RunAdvice> advice;
  std::vector<std::pair<std::string, std::string>> cards;   // a figure, and what it is
  std::vector<std::pair<std::string, std::string>> facts;   // what ran with which inputs
  std::vector<std::pair<std::string, std::string>> inputs;  // file, SHA-256
  std::vector<std::string> forces;           // names; RunColumn::forces are in this order
  int forces_left_out = 0;                   // that are not shown, for they are too many
  std::vector<int> markers;                  // ids; RunColumn::markers are in this order
  std::vector<std::string> marker_statuses;  // from the best to the gravest
  RunColumns time;
  std::vector<StageRow> stages;
  std::vector<KeyPicture> pictures;
  BodyShape body;
  std::vector<BodyView> views;  // in the order of the frames
  int first_view = 0;           // the one to show first
};

// The report as one HTML page: charts, pictures and a view of the body in three dimensions. It
// needs no other file and no network. A program that was built without its 3-D view says so.
std::string RunPage(const RunRecord& record);

}  // namespace softforce::report
