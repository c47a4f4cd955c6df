#include "vision/mp4_salvage.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "vision/h264_headers.h"
#include "vision/mp4_boxes.h"

namespace softforce::vision {
namespace {

// When the pictures of one IDR sequence are shown, as picture order counts in the order of storage.
using Sequence = std::vector<int>;

// Pictures of which all slices are there. The last one is dropped unless `complete`, or the next
// one has begun.
std::vector<Sequence> WholePictures(const Bytes& bytes, const std::vector<Span>& units,
                                    const H264Sequence& header, bool complete) {
  std::vector<Sequence> sequences;
  const int modulus = 1 << header.order_bits;
  bool open = false;  // whether more slices of the last picture may follow
  for (const Span& unit : units) {
    const uint8_t* data = bytes.data() + unit.begin;
    if (!IsSlice(data[0])) {
      if (StandsBeforePicture(data[0])) open = false;
      continue;
    }
    const auto slice = ReadSlice(header, data, unit.size());
    if (!slice) break;
    if (slice->starts_picture) open = false;
    if (unit.clipped) break;
    if (!slice->starts_picture) continue;
    if (slice->starts_sequence || sequences.empty()) sequences.emplace_back();
    Sequence& orders = sequences.back();
    int order = slice->order;
    if (header.order_bits == 0) {
      order = static_cast<int>(orders.size());
    } else if (!orders.empty()) {
      // The count that is nearest to the picture before.
      const int ahead = ((order - orders.back()) % modulus + modulus) % modulus;
      order = orders.back() + (ahead < modulus / 2 ? ahead : ahead - modulus);
    }
    orders.push_back(order);
    open = true;
  }
  if (open && !complete) sequences.back().pop_back();
  return sequences;
}

// How far the order count goes on from one shown picture to the next.
int OrderStep(std::vector<Sequence> sequences) {
  int step = 1 << 16;  // no count is longer
  for (Sequence& orders : sequences) {
    std::sort(orders.begin(), orders.end());
    for (size_t i = 1; i < orders.size(); ++i) step = std::min(step, orders[i] - orders[i - 1]);
  }
  return step;
}

int Count(const std::vector<Sequence>& sequences) {
  size_t count = 0;
  for (const Sequence& orders : sequences) count += orders.size();
  return static_cast<int>(count);
}

// Shown pictures before the first that is missing. Only the last sequence can lack any.
int CountToFirstGap(std::vector<Sequence> sequences, int step) {
  if (sequences.empty()) return 0;
  Sequence last = std::move(sequences.back());
  sequences.pop_back();
  std::sort(last.begin(), last.end());
  size_t shown = 0;
  while (shown < last.size() && last[shown] == last[0] + static_cast<int>(shown) * step) ++shown;
  return Count(sequences) + static_cast<int>(shown);
}

void AppendUnit(const Bytes& from, const Span& unit, Bytes* to) {
  const uint8_t start_code[] = {0, 0, 0, 1};
  to->insert(to->end(), start_code, start_code + 4);
  to->insert(to->end(), from.begin() + static_cast<std::ptrdiff_t>(unit.begin),
             from.begin() + static_cast<std::ptrdiff_t>(unit.end));
}

}  // namespace

SalvagedVideo::SalvagedVideo(std::filesystem::path file, int announced_frames, int whole_frames,
                             double frames_per_second)
    : file_(std::move(file)),
      announced_frames_(announced_frames),
      whole_frames_(whole_frames),
      frames_per_second_(frames_per_second) {}

SalvagedVideo::~SalvagedVideo() {
  std::error_code ignored;
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

SalvagedVideo::SalvagedVideo(SalvagedVideo&& other) noexcept
    : file_(std::move(other.file_)),
      announced_frames_(other.announced_frames_),
      whole_frames_(other.whole_frames_),
      frames_per_second_(other.frames_per_second_) {
  other.file_.clear();
}

SalvagedVideo& SalvagedVideo::operator=(SalvagedVideo&& other) noexcept {
  std::swap(file_, other.file_);
  announced_frames_ = other.announced_frames_;
  whole_frames_ = other.whole_frames_;
  frames_per_second_ = other.frames_per_second_;
  return *this;
}

bool IsMp4WithoutIndex(const std::filesystem::path& file) {
  const Bytes bytes = ReadAll(file);
  const auto moov = TopLevelBox(bytes, "moov");
  return TopLevelBox(bytes, "ftyp") && TopLevelBox(bytes, "mdat") && (!moov || moov->clipped);
}

std::optional<SalvagedVideo> SalvageMp4(const std::filesystem::path& file,
                                        const std::filesystem::path& sibling) {
  if (!IsMp4WithoutIndex(file)) return std::nullopt;
  const Bytes model = ReadAll(sibling);
  const std::optional<StreamParameters> parameters = ReadParameters(model);
  cv::VideoCapture complete(sibling.string(), cv::CAP_FFMPEG);
  const std::optional<Span> model_mdat = TopLevelBox(model, "mdat");
  if (!parameters || !model_mdat || !complete.isOpened()) return std::nullopt;
  const auto announced = static_cast<int>(std::lround(complete.get(cv::CAP_PROP_FRAME_COUNT)));

  // The complete file shows whether the units are stored as they are taken to be.
  const auto pictures_of = [&](const Bytes& bytes, const std::vector<Span>& units,
                               bool to_the_end) {
    return WholePictures(bytes, units, parameters->sequence, to_the_end);
  };
  const std::vector<Sequence> model_pictures =
      pictures_of(model, UnitsIn(model, *model_mdat, parameters->length_size), true);
  if (Count(model_pictures) != announced) return std::nullopt;

  const Bytes bytes = ReadAll(file);
  const Span mdat = *TopLevelBox(bytes, "mdat");
  const std::vector<Span> units = UnitsIn(bytes, mdat, parameters->length_size);
  const int whole =
      CountToFirstGap(pictures_of(bytes, units, !mdat.clipped), OrderStep(model_pictures));
  if (whole == 0) return std::nullopt;
  Bytes stream;
  for (const Span& set : parameters->parameter_sets) AppendUnit(model, set, &stream);
  for (const Span& unit : units) {
    if (!unit.clipped) AppendUnit(bytes, unit, &stream);
  }

  std::string name = (std::filesystem::temp_directory_path() / "softforce-XXXXXX.h264").string();
  const int descriptor = mkstemps(name.data(), 5);
  if (descriptor < 0) return std::nullopt;
  close(descriptor);
  SalvagedVideo salvaged(name, announced, whole, complete.get(cv::CAP_PROP_FPS));
  std::ofstream out(name, std::ios::binary);
  out.write(reinterpret_cast<const char*>(stream.data()),
            static_cast<std::streamsize>(stream.size()));
  out.close();
  if (!out) return std::nullopt;
  return salvaged;
}

}  // namespace softforce::vision
