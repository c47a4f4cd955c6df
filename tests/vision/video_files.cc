#include "vision/video_files.h"

#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>

#include "softforce/base/input_error.h"

namespace softforce::testing {
namespace fs = std::filesystem;

fs::path TempFolder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (char& c : name) {
    if (c == '/') c = '-';
  }
  const fs::path folder = fs::path(::testing::TempDir()) / ("softforce-" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

int GroundLevel(int frame) { return 40 + 5 * frame; }
int BarLevel(int frame) { return 230 - 4 * frame; }

cv::Mat NumberedPicture(int frame, cv::Size size) {
  cv::Mat picture(size, CV_8UC1, cv::Scalar(GroundLevel(frame)));
  picture(cv::Rect(16 + 4 * frame, 32, 64, 64)).setTo(BarLevel(frame));
  // Detail, without which the compressed pictures would be tiny.
  cv::RNG random(static_cast<uint64_t>(frame) + 1);
  random.fill(picture(cv::Rect(0, size.height - 16, size.width, 16)), cv::RNG::UNIFORM, 0, 255);
  return picture;
}

fs::path WriteVideo(const fs::path& stem, const VideoKind& kind) {
  fs::path file = stem;
  file += kind.extension;
  const std::string& code = kind.fourcc;
  cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]),
                         kind.frames_per_second, kind.size, false);
  EXPECT_TRUE(writer.isOpened()) << file;
  for (int frame = 0; frame < kind.frames; ++frame) writer.write(NumberedPicture(frame, kind.size));
  return file;
}

fs::path CutFile(const fs::path& file, double share, const fs::path& to) {
  fs::copy_file(file, to, fs::copy_options::overwrite_existing);
  fs::permissions(to, fs::perms::owner_write, fs::perm_options::add);
  fs::resize_file(to, static_cast<uintmax_t>(share * static_cast<double>(fs::file_size(file))));
  return to;
}

camera::Rig RigOf(cv::Size size) {
  camera::Rig rig;
  for (const char* name : {"left", "right"}) {
    camera::Camera camera;
    camera.name = name;
    camera.width = size.width;
    camera.height = size.height;
    rig.cameras.push_back(camera);
  }
  return rig;
}

std::vector<cv::Mat> AllPictures(vision::Recording* recording, int camera) {
  std::vector<cv::Mat> pictures;
  while (const auto frame = recording->Next()) pictures.push_back(frame->pictures[camera]);
  return pictures;
}

std::string Refusal(const camera::Rig& rig, const std::vector<vision::Recording::Source>& sources) {
  try {
    vision::Recording recording(rig, sources);
    ADD_FAILURE() << "accepted";
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace softforce::testing
