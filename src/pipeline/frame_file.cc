#include "pipeline/frame_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "softforce/base/input_error.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "frames.bin is little-endian");

namespace softforce::pipeline {
namespace {

constexpr char kTitle[] = "softforce frames 2\n";
constexpr double kSteps = 32767;        // of a displacement, to either side
constexpr int32_t kMostItems = 100000;  // forces or markers of one frame

using Shape = Eigen::Matrix<int16_t, 3, Eigen::Dynamic>;

template <class Number>
void Put(std::ostream* out, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  out->write(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Matrix>
void PutMatrix(std::ostream* out, const Matrix& m) {
  out->write(reinterpret_cast<const char*>(m.data()),
             static_cast<std::streamsize>(sizeof(*m.data())) * m.size());
}

template <class Number>
Number Get(std::istream* in) {
  Number value{};
  in->read(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

template <class Matrix>
void GetMatrix(std::istream* in, Matrix* m) {
  in->read(reinterpret_cast<char*>(m->data()),
           static_cast<std::streamsize>(sizeof(*m->data())) * m->size());
}

base::InputError Spoilt(const std::filesystem::path& path, const std::string& what) {
  return {path.string(), what, "Make it again with: softforce run"};
}

int32_t GetCount(const std::filesystem::path& path, std::istream* in) {
  const auto count = Get<int32_t>(in);
  if (!*in || count < 0 || count > kMostItems) {
    throw Spoilt(path, "is cut off, or no file of frames: a count in it cannot be");
  }
  return count;
}

void PutForce(std::ostream* out, const ForceResult& force) {
  Put<int32_t>(out, force.identity);
  Put<int32_t>(out, force.candidate);
  for (const auto* vector : {&force.position, &force.rest, &force.force}) PutMatrix(out, *vector);
  PutMatrix(out, force.covariance);
  PutMatrix(out, force.place_covariance);
  Put(out, static_cast<int32_t>(force.alternatives.size()));
  for (const int candidate : force.alternatives) Put<int32_t>(out, candidate);
}

ForceResult GetForce(const std::filesystem::path& path, std::istream* in) {
  ForceResult force;
  force.identity = Get<int32_t>(in);
  force.candidate = Get<int32_t>(in);
  for (auto* vector : {&force.position, &force.rest, &force.force}) GetMatrix(in, vector);
  GetMatrix(in, &force.covariance);
  GetMatrix(in, &force.place_covariance);
  const int32_t alternatives = GetCount(path, in);
  for (int32_t a = 0; a < alternatives; ++a) force.alternatives.push_back(Get<int32_t>(in));
  return force;
}

void PutMarker(std::ostream* out, const MarkerResult& marker) {
  Put<int32_t>(out, marker.id);
  Put<int32_t>(out, static_cast<int32_t>(marker.status));
  Put<int32_t>(out, marker.expected_absent ? 1 : 0);
  PutMatrix(out, marker.measured);
  PutMatrix(out, marker.model);
  PutMatrix(out, marker.expected_covariance);
}

MarkerResult GetMarker(std::istream* in) {
  MarkerResult marker;
  marker.id = Get<int32_t>(in);
  marker.status = static_cast<MarkerStatus>(Get<int32_t>(in));
  marker.expected_absent = Get<int32_t>(in) != 0;
  GetMatrix(in, &marker.measured);
  GetMatrix(in, &marker.model);
  GetMatrix(in, &marker.expected_covariance);
  return marker;
}

// m, the least power of two by which the largest component takes no more than kSteps. It is the
// same for the shape that is given back.
double StepFor(const Eigen::Matrix3Xd& u) {
  const double largest = u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0;
  return largest > 0 ? std::exp2(std::ceil(std::log2(largest / kSteps))) : 1;
}

Shape InSteps(const Eigen::Matrix3Xd& u, double step) {
  return (u / step).array().round().cast<int16_t>();
}

void PutShape(std::ostream* out, const Eigen::Matrix3Xd& u) {
  const double step = StepFor(u);
  Put(out, step);
  PutMatrix(out, InSteps(u, step));
}

}  // namespace

Eigen::Matrix3Xd AsKept(const Eigen::Matrix3Xd& u) {
  const double step = StepFor(u);
  return step * InSteps(u, step).cast<double>();
}

FrameFileWriter::FrameFileWriter(const std::filesystem::path& path, int num_nodes)
    : file_(path), stream_(file_.temporary(), std::ios::binary) {
  if (!stream_) {
    throw base::InputError(
        path.string(), "cannot be written",
        "Choose another folder with --out, or check its permissions and the disk's space.");
  }
  stream_ << kTitle;
  Put<int32_t>(&stream_, num_nodes);
}

void FrameFileWriter::Add(const FrameInWork& frame) {
  const FrameResult& result = frame.result;
  Put<int32_t>(&stream_, result.frame);
  Put(&stream_, result.time_s);
  Put<int32_t>(&stream_, static_cast<int32_t>(result.status));
  Put(&stream_, result.probability);
  PutMatrix(&stream_, frame.T_rig_robot.matrix());
  Put(&stream_, frame.largest_displacement);
  Put(&stream_, static_cast<int32_t>(result.forces.size()));
  for (const ForceResult& force : result.forces) PutForce(&stream_, force);
  Put(&stream_, static_cast<int32_t>(result.markers.size()));
  for (const MarkerResult& marker : result.markers) PutMarker(&stream_, marker);
  PutShape(&stream_, frame.u);
}

void FrameFileWriter::Commit() {
  stream_.close();
  if (!stream_) {
    throw base::InputError(file_.path().string(), "could not be written to the end",
                           "Check the disk's space.");
  }
  file_.Commit();
}

FrameFileReader::FrameFileReader(const std::filesystem::path& path, int num_nodes)
    : path_(path), stream_(path, std::ios::binary), num_nodes_(num_nodes) {
  if (!stream_) {
    throw base::InputError(path.string(), "is not there or cannot be read",
                           "It is written by: softforce run (but not with --no-frames)");
  }
  std::string title(sizeof kTitle - 1, '\0');
  stream_.read(title.data(), static_cast<std::streamsize>(title.size()));
  if (title != kTitle) throw Spoilt(path, "is no file of frames of this version of softforce");
  const auto nodes = Get<int32_t>(&stream_);
  if (!stream_ || nodes != num_nodes) {
    throw base::InputError(
        path.string(),
        fmt::format("is of a body of {} nodes, but the scene's mesh now has {}", nodes, num_nodes),
        "Give the scene that the run was made with (--scene), or run again.");
  }
}

std::optional<FrameInWork> FrameFileReader::Next() {
  if (stream_.peek() == std::ifstream::traits_type::eof()) return std::nullopt;
  FrameInWork frame;
  FrameResult& result = frame.result;
  result.frame = Get<int32_t>(&stream_);
  result.time_s = Get<double>(&stream_);
  result.status = static_cast<estimation::ForceEstimate::Status>(Get<int32_t>(&stream_));
  result.probability = Get<double>(&stream_);
  GetMatrix(&stream_, &frame.T_rig_robot.matrix());
  frame.largest_displacement = Get<double>(&stream_);
  const int32_t forces = GetCount(path_, &stream_);
  for (int32_t f = 0; f < forces && stream_; ++f)
    result.forces.push_back(GetForce(path_, &stream_));
  const int32_t markers = GetCount(path_, &stream_);
  for (int32_t m = 0; m < markers && stream_; ++m) result.markers.push_back(GetMarker(&stream_));
  const auto step = Get<double>(&stream_);
  Shape shape(3, num_nodes_);
  GetMatrix(&stream_, &shape);
  if (!stream_) throw Spoilt(path_, "is cut off");
  if (!std::isfinite(step) || !frame.T_rig_robot.matrix().allFinite()) {
    throw Spoilt(path_, fmt::format("frame {} holds numbers that are none", result.frame));
  }
  frame.u = step * shape.cast<double>();
  return frame;
}

}  // namespace softforce::pipeline
