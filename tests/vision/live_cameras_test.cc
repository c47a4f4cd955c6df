#include "softforce/vision/live_cameras.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "softforce/base/input_error.h"
#include "softforce/vision/recorder.h"
#include "softforce/vision/recording.h"
#include "support/bar_code.h"
#include "vision/live_servers.h"
#include "vision/video_files.h"

namespace softforce::vision {
namespace {

using softforce::testing::CameraServer;
using softforce::testing::FreePort;
using softforce::testing::ReadNumber;
using softforce::testing::RigOf;
using softforce::testing::TempFolder;
using std::chrono::seconds;
using std::chrono::steady_clock;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

const cv::Size kSize(320, 240);
constexpr double kRate = 30;        // Hz
constexpr seconds kLongEnough(60);  // on the slowest machine; a healthy one takes 2 s

// A way to serve a camera, with PORT in both texts.
struct Transport {
  const char* name;
  const char* serve;
  const char* source;
};

std::string At(std::string text, int port) {
  return text.replace(text.find("PORT"), 4, std::to_string(port));
}

const Transport kMotionJpeg{"MotionJpegOverTcp",
                            "-c:v mjpeg -q:v 3 -f mjpeg "
                            "'tcp://127.0.0.1:PORT?listen=1&tcp_nodelay=1'",
                            "tcp://127.0.0.1:PORT"};
const Transport kMultipart{"MultipartJpegOverHttp",
                           "-c:v mjpeg -q:v 3 -f mpjpeg -listen 1 http://127.0.0.1:PORT/video",
                           "http://127.0.0.1:PORT/video"};
// With time stamps, so that a busy computer cannot make the cameras' rhythm unknowable.
const Transport kMatroska{"MatroskaOverTcp",
                          "-c:v mjpeg -q:v 3 -f matroska -live 1 -cluster_time_limit 1 "
                          "'tcp://127.0.0.1:PORT?listen=1&tcp_nodelay=1'",
                          "tcp://127.0.0.1:PORT"};

// A rig of two cameras that are served.
class Served {
 public:
  explicit Served(const Transport& transport, double jitter_ms = 0, double drop_share = 0) {
    for (int c = 0; c < 2; ++c) {
      const int port = FreePort();
      servers_.push_back(std::make_unique<CameraServer>(
          kSize.width, kSize.height, kRate, At(transport.serve, port), jitter_ms, drop_share));
      cameras_.push_back({c == 0 ? "left" : "right", At(transport.source, port), kSize, 0});
    }
    // Not with a connection, which would be the only one that the server takes.
    for (const auto start = steady_clock::now(); steady_clock::now() - start < kLongEnough;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      if (Listens(0) && Listens(1)) break;
    }
  }

  CameraServer& server(int c) { return *servers_[c]; }
  const std::vector<LiveCamera>& cameras() const { return cameras_; }

 private:
  bool Listens(int c) const {
    const std::string& source = cameras_[c].source;
    const int port = std::stoi(source.substr(source.find(':', 6) + 1));
    const std::string wanted = fmt::format("0100007F:{:04X} 00000000:0000 0A", port);
    std::ifstream sockets("/proc/net/tcp");
    for (std::string line; std::getline(sockets, line);) {
      if (line.find(wanted) != std::string::npos) return true;
    }
    return false;
  }

  std::vector<std::unique_ptr<CameraServer>> servers_;
  std::vector<LiveCamera> cameras_;
};

// Whether both pictures of a set are of one moment; and that moment.
uint32_t ExpectOneNumber(const FrameSet& set) {
  EXPECT_EQ(set.pictures.size(), 2u);
  const auto left = ReadNumber(set.pictures[0]), right = ReadNumber(set.pictures[1]);
  EXPECT_TRUE(left && right) << "set " << set.frame;
  EXPECT_EQ(left.value_or(1), right.value_or(2)) << "set " << set.frame;
  return left.value_or(0);
}

// Fetches sets until `enough`, and holds each against its numbers.
template <class Enough>
int FetchUntil(LiveCameras* live, Enough enough) {
  int fetched = 0;
  const auto start = steady_clock::now();
  while (!enough(fetched) && steady_clock::now() - start < kLongEnough) {
    const auto set = live->Next();
    if (!set) break;
    ExpectOneNumber(*set);
    ++fetched;
  }
  EXPECT_TRUE(enough(fetched)) << live->Report().FullReport();
  return fetched;
}

class LiveOver : public ::testing::TestWithParam<Transport> {};

TEST_P(LiveOver, PairsPicturesOfOneMoment) {
  Served served(GetParam());
  LiveCameras live(served.cameras());
  std::vector<uint32_t> numbers;
  std::vector<double> times_s;
  const auto start = steady_clock::now();
  // A stream without time stamps may give few sets on a busy computer, but none that is wrong.
  while (numbers.size() < 30 && (numbers.empty() || steady_clock::now() - start < seconds(10))) {
    const auto set = live.Next();
    ASSERT_TRUE(set);
    numbers.push_back(ExpectOneNumber(*set));
    times_s.push_back(set->time_s);
    EXPECT_EQ(set->frame, static_cast<int>(numbers.size()) - 1);
    EXPECT_EQ(set->camera_time_s.size(), 2u);
  }

  EXPECT_EQ(times_s[0], 0);
  // Time stamps follow the pictures' numbers to half a period, whatever was left out.
  for (size_t k = 0; k < numbers.size(); ++k) {
    EXPECT_NEAR(times_s[k], (numbers[k] - numbers[0]) / kRate, 0.5 / kRate) << k;  // s
  }
  const SourceReport report = live.Report();
  EXPECT_EQ(report.delivered, static_cast<int64_t>(numbers.size()));
  for (const CameraReport& camera : report.cameras) {
    EXPECT_EQ(camera.state, CameraReport::State::kRunning);
    EXPECT_GE(camera.received, camera.paired + camera.unpaired + camera.unsure);
  }
}

INSTANTIATE_TEST_SUITE_P(Loopback, LiveOver, ::testing::Values(kMotionJpeg, kMultipart, kMatroska),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(LiveCameras, PairNothingWrongWhenPicturesComeLateOrNotAtAll) {
  // Late by up to 90 % of the time between two pictures; one in twenty is left out.
  Served served(kMatroska, 30, 0.05);
  LiveCameras live(served.cameras());

  FetchUntil(&live, [](int fetched) { return fetched >= 30; });
}

TEST(LiveCameras, OneThatIsKilledComesBackWhileTheOtherGoesOn) {
  Served served(kMatroska);
  LiveOptions options;
  options.settle_s = 0.5;
  LiveCameras live(served.cameras(), options);
  FetchUntil(&live, [](int fetched) { return fetched >= 15; });

  served.server(1).Kill();
  const auto report_until = [&](auto holds) {
    for (const auto start = steady_clock::now(); steady_clock::now() - start < kLongEnough;) {
      if (holds(live.Report())) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  };
  EXPECT_TRUE(report_until(
      [](const SourceReport& r) { return r.cameras[1].state == CameraReport::State::kAway; }));
  const int64_t received = live.Report().cameras[0].received;
  EXPECT_TRUE(
      report_until([&](const SourceReport& r) { return r.cameras[0].received >= received + 10; }));
  served.server(1).Start();
  EXPECT_TRUE(report_until([](const SourceReport& r) {
    return r.cameras[1].reopened == 1 && r.cameras[1].state == CameraReport::State::kRunning;
  }));

  const int64_t paired = live.Report().cameras[1].paired;
  FetchUntil(&live, [&](int) { return live.Report().cameras[1].paired >= paired + 15; });
  EXPECT_THAT(live.TakeMessages(), AllOf(Contains(HasSubstr("\"right\": lost")),
                                         Contains(HasSubstr("\"right\": back"))));
  EXPECT_TRUE(live.TakeMessages().empty());
  EXPECT_EQ(live.Report().cameras[0].reopened, 0);
}

TEST(LiveCameras, OneThatStallsIsReportedAndTheProgramStopsAllTheSame) {
  Served served(kMatroska);
  LiveOptions options;
  options.stall_s = 0.5;
  LiveCameras live(served.cameras(), options);
  FetchUntil(&live, [](int fetched) { return fetched >= 3; });

  served.server(0).Freeze();
  std::vector<std::string> messages;
  for (const auto start = steady_clock::now();
       messages.empty() && steady_clock::now() - start < kLongEnough;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    messages = live.TakeMessages();
  }
  EXPECT_THAT(messages, Contains(AllOf(HasSubstr("\"left\": lost"), HasSubstr("no picture"))));

  std::thread stopper([&] { live.Stop(); });  // ends a Next() that waits, and waits for no camera
  while (live.Next()) {
  }
  stopper.join();
  served.server(0).Unfreeze();
}

TEST(LiveCameras, DropTheOldestSetsThatNobodyFetches) {
  Served served(kMatroska);
  LiveOptions options;
  options.settle_s = 0.5;
  options.queue = 2;
  LiveCameras live(served.cameras(), options);
  for (const auto start = steady_clock::now();
       live.Report().dropped < 5 && steady_clock::now() - start < kLongEnough;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  const SourceReport report = live.Report();
  EXPECT_GE(report.dropped, 5);
  EXPECT_EQ(report.queued, 2);
  EXPECT_EQ(report.cameras[0].paired, report.delivered + report.dropped + report.queued);
  const auto set = live.Next();
  ASSERT_TRUE(set);
  EXPECT_EQ(set->frame, 0);  // counted as delivered
}

TEST(LiveCameras, AreRecordedAndPlayedBackToTheLastBit) {
  Served served(kMatroska);
  const std::filesystem::path folder = TempFolder() / "recorded";
  std::vector<FrameSet> sets;
  {
    LiveOptions options;
    options.settle_s = 0.5;
    LiveCameras live(served.cameras(), options);
    RecorderOptions recorder_options;
    recorder_options.segment_s = 0.2;
    recorder_options.wait = true;
    Recorder recorder(folder, {"left", "right"}, recorder_options);
    while (sets.size() < 20) {
      const auto set = live.Next();
      ASSERT_TRUE(set);
      recorder.Add(*set);
      sets.push_back(*set);
    }
    recorder.Finish();
  }
  Recording recording(RigOf(kSize), {{"left", folder / "left"}, {"right", folder / "right"}});
  for (const FrameSet& set : sets) {
    const auto played = recording.Next();
    ASSERT_TRUE(played);
    EXPECT_EQ(played->frame, set.frame);
    EXPECT_EQ(played->time_s, set.time_s);
    EXPECT_EQ(played->camera_time_s, set.camera_time_s);
    for (int c = 0; c < 2; ++c) {
      EXPECT_EQ(cv::norm(played->pictures[c], set.pictures[c], cv::NORM_INF), 0);
    }
  }
}

TEST(LiveCameras, TakeGStreamerPipelines) {
  const std::string source =
      "videotestsrc is-live=true pattern={} ! video/x-raw,width=320,height=240,framerate=30/1";
  LiveOptions options;
  options.settle_s = 0.3;
  LiveCameras live({{"left", fmt::format(source, "white"), kSize, 0},
                    {"right", fmt::format(source, "black"), kSize, 0}},
                   options);
  const auto set = live.Next();
  ASSERT_TRUE(set);
  EXPECT_GT(cv::mean(set->pictures[0])[0], 225);  // grey levels; video's white is 235
  EXPECT_LT(cv::mean(set->pictures[1])[0], 30);
  EXPECT_EQ(set->pictures[0].size(), kSize);
}

TEST(SourceKind, IsToldFromTheText) {
  EXPECT_EQ(KindOf("/dev/video0"), SourceKind::kDevice);
  EXPECT_EQ(KindOf("0"), SourceKind::kDevice);
  EXPECT_EQ(KindOf("rtsp://10.0.0.7/stream"), SourceKind::kUrl);
  EXPECT_EQ(KindOf("tcp://127.0.0.1:5000"), SourceKind::kUrl);
  EXPECT_EQ(KindOf("v4l2src ! videoconvert"), SourceKind::kPipeline);
  EXPECT_EQ(KindOf("rtspsrc location=rtsp://a/b ! decodebin"), SourceKind::kPipeline);
  EXPECT_EQ(KindOf("left.mp4"), SourceKind::kFile);
  EXPECT_EQ(KindOf("recorded/left"), SourceKind::kFile);
  EXPECT_EQ(KindOf(""), SourceKind::kFile);
  const auto odd = TempFolder() / "take 1 ! best.mp4";
  std::ofstream(odd) << "x";
  EXPECT_EQ(KindOf(odd.string()), SourceKind::kFile);
}

std::string RefusalOf(std::vector<LiveCamera> cameras, const LiveOptions& options = {}) {
  try {
    const LiveCameras live(std::move(cameras), options);
    ADD_FAILURE() << "accepted";
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(LiveCamerasRefusal, NamesACameraThatCannotBeOpened) {
  const std::string source = fmt::format("tcp://127.0.0.1:{}", FreePort());
  EXPECT_THAT(RefusalOf({{"left", source, {}, 0}}),
              AllOf(HasSubstr("camera \"left\""), HasSubstr(source),
                    HasSubstr("cannot be opened: Connection refused")));
  EXPECT_THAT(RefusalOf({{"left", "/dev/video97", {}, 0}}),
              HasSubstr("there is no device /dev/video97"));
  EXPECT_THAT(RefusalOf({{"left", "97", {}, 0}}), HasSubstr("there is no device /dev/video97"));
  EXPECT_THAT(RefusalOf({{"left", "/dev/null", {}, 0}}), HasSubstr("/dev/null is no camera"));
  EXPECT_THAT(RefusalOf({{"left", "nosuchelement ! identity", {}, 0}}), HasSubstr("nosuchelement"));
}

TEST(LiveCamerasRefusal, NamesBothSizesOfPictures) {
  EXPECT_THAT(RefusalOf({{"left",
                          "videotestsrc is-live=true ! video/x-raw,width=320,height=240",
                          {1280, 1024},
                          0}}),
              AllOf(HasSubstr("320x240"), HasSubstr("1280x1024")));
}

TEST(LiveCamerasRefusal, NamesWhatIsGivenTwiceOrNotAtAll) {
  EXPECT_THAT(RefusalOf({}), HasSubstr("there is none"));
  EXPECT_THAT(RefusalOf({{"left", "0", {}, 0}, {"left", "1", {}, 0}}),
              HasSubstr("two cameras are called \"left\""));
  EXPECT_THAT(RefusalOf({{"left", "0", {}, 0}, {"right", "0", {}, 0}}),
              HasSubstr("two cameras have the same source"));
  EXPECT_THAT(RefusalOf({{"", "0", {}, 0}}), HasSubstr("has no name"));
  EXPECT_THAT(RefusalOf({{"left", "left.mp4", {}, 0}}), HasSubstr("no live camera"));
  EXPECT_THAT(RefusalOf({{"left", "0", {}, NAN}}), HasSubstr("time offset"));
}

struct BadOption {
  const char* name;
  double LiveOptions::*number;
  double value;
};

TEST(LiveCamerasRefusal, NamesOptionsOutOfRange) {
  const BadOption bad[] = {{"--tolerance", &LiveOptions::tolerance_s, 0},
                           {"--max-wait", &LiveOptions::max_wait_s, 11},
                           {"--open-timeout", &LiveOptions::open_timeout_s, 0},
                           {"--stall", &LiveOptions::stall_s, -1},
                           {"--settle", &LiveOptions::settle_s, 0},
                           {"longest pause", &LiveOptions::longest_pause_s, 0},
                           {"--rate", &LiveOptions::rate_hz, -30}};
  for (const BadOption& each : bad) {
    LiveOptions options;
    options.*each.number = each.value;
    EXPECT_THAT(RefusalOf({{"left", "0", {}, 0}}, options), HasSubstr(each.name));
  }
  LiveOptions options;
  options.queue = 0;
  EXPECT_THAT(RefusalOf({{"left", "0", {}, 0}}, options), HasSubstr("--queue"));
  options = {};
  options.pixel_format = "YUV";
  EXPECT_THAT(RefusalOf({{"left", "0", {}, 0}}, options), HasSubstr("--pixel-format"));
}

TEST(OpenFrameSource, NamesAMixtureOfLiveCamerasAndFiles) {
  try {
    OpenFrameSource(RigOf(kSize), {{"left", "/dev/video0"}, {"right", "right.mp4"}});
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("\"left\" is live"), HasSubstr("right.mp4")));
  }
}

TEST(OpenFrameSource, NamesCamerasThatTheRigHasNot) {
  EXPECT_THROW(OpenFrameSource(RigOf(kSize), {{"left", "0"}}), base::InputError);
  EXPECT_THROW(OpenFrameSource(RigOf(kSize), {{"left", "0"}, {"right", "1"}, {"top", "2"}}),
               base::InputError);
  EXPECT_THROW(OpenFrameSource(RigOf(kSize), {{"left", "0"}, {"right", "1"}}, {}, {{"top", 0.01}}),
               base::InputError);
}

}  // namespace
}  // namespace softforce::vision
