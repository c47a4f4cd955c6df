#include <fmt/format.h>
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include "vision/camera_stream.h"

namespace softforce::vision {
namespace {

struct Unref {
  void operator()(GstElement* p) const { gst_object_unref(p); }
  void operator()(GstSample* p) const { gst_sample_unref(p); }
  void operator()(GstMessage* p) const { gst_message_unref(p); }
  void operator()(GstBus* p) const { gst_object_unref(p); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

constexpr const char* kSink =
    " ! videoconvert ! video/x-raw,format=GRAY8 "
    "! appsink name=softforce sync=false max-buffers=2 drop=true";

// Ends a pipeline, whatever state it is in, before it is freed.
class Pipeline {
 public:
  explicit Pipeline(GstElement* pipeline) : pipeline_(pipeline) {}
  ~Pipeline() {
    if (pipeline_ != nullptr) gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  }
  Pipeline(Pipeline&&) = default;

  GstElement* get() const { return pipeline_.get(); }

  std::string Error() const {
    const Owned<GstBus> bus(gst_element_get_bus(pipeline_.get()));
    const Owned<GstMessage> message(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
    if (message == nullptr) return "";
    GError* error = nullptr;
    gst_message_parse_error(message.get(), &error, nullptr);
    std::string text = error->message;
    g_error_free(error);
    return text;
  }

 private:
  Owned<GstElement> pipeline_;
};

class PipelineStream : public CameraStream {
 public:
  PipelineStream(Pipeline pipeline, Patience* patience)
      : pipeline_(std::move(pipeline)),
        sink_(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "softforce")),
        patience_(patience) {}

  std::optional<Grabbed> Grab() override {
    constexpr GstClockTime kLook = 50 * GST_MSECOND;  // between looks at whether to go on
    auto* sink = GST_APP_SINK(sink_.get());
    while (!patience_->over()) {
      const Owned<GstSample> sample(gst_app_sink_try_pull_sample(sink, kLook));
      if (sample != nullptr) return Read(sample.get());
      problem_ = pipeline_.Error();
      if (!problem_.empty()) return std::nullopt;
      if (gst_app_sink_is_eos(sink) != 0) {
        problem_ = "the pipeline ended";
        return std::nullopt;
      }
    }
    problem_ = "the pipeline gives no picture";
    return std::nullopt;
  }

 private:
  std::optional<Grabbed> Read(GstSample* sample) {
    Grabbed grabbed;
    grabbed.arrival_s = MonotonicNow();
    GstBuffer* buffer = gst_sample_get_buffer(sample);
    GstVideoInfo info;
    GstVideoFrame frame;
    if (gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) == 0 ||
        gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ) == 0) {
      problem_ = "the pipeline's pictures cannot be read";
      return std::nullopt;
    }
    grabbed.grey = cv::Mat(GST_VIDEO_FRAME_HEIGHT(&frame), GST_VIDEO_FRAME_WIDTH(&frame), CV_8UC1,
                           GST_VIDEO_FRAME_PLANE_DATA(&frame, 0),
                           static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)))
                       .clone();
    gst_video_frame_unmap(&frame);
    if (GST_BUFFER_PTS_IS_VALID(buffer)) {
      grabbed.stream_s = 1e-9 * static_cast<double>(GST_BUFFER_PTS(buffer));
    }
    return grabbed;
  }

  Pipeline pipeline_;
  Owned<GstElement> sink_;
  Patience* patience_;
};

}  // namespace

OpenedStream OpenPipeline(const LiveCamera& camera, Patience* patience, std::string* problem) {
  gst_init(nullptr, nullptr);
  GError* error = nullptr;
  Pipeline pipeline(gst_parse_launch((camera.source + kSink).c_str(), &error));
  if (error != nullptr) {
    *problem = fmt::format("GStreamer says: {}", error->message);
    g_error_free(error);
    return nullptr;
  }
  if (gst_element_set_state(pipeline.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
    const std::string said = pipeline.Error();
    *problem = said.empty() ? "the pipeline does not start" : "GStreamer says: " + said;
    return nullptr;
  }
  return std::make_unique<PipelineStream>(std::move(pipeline), patience);
}

}  // namespace softforce::vision
