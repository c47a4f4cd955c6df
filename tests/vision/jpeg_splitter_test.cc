#include "vision/jpeg_splitter.h"

#include <opencv2/imgcodecs.hpp>
#include <string>

namespace softforce::vision {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes JpegOf(int seed, cv::Size size = {64, 48}) {
  cv::Mat picture(size, CV_8UC1);
  cv::RNG random(static_cast<uint64_t>(seed));
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  Bytes jpeg;
  cv::imencode(".jpg", picture, jpeg);
  return jpeg;
}

// A picture with another one inside a comment, as a preview would be.
Bytes WithPreview(const Bytes& jpeg, const Bytes& preview) {
  Bytes with{0xFF, 0xD8, 0xFF, 0xFE};
  const size_t length = preview.size() + 2;
  with.push_back(static_cast<uint8_t>(length >> 8));
  with.push_back(static_cast<uint8_t>(length & 0xFF));
  with.insert(with.end(), preview.begin(), preview.end());
  with.insert(with.end(), jpeg.begin() + 2, jpeg.end());
  return with;
}

void Append(Bytes* to, const Bytes& what) { to->insert(to->end(), what.begin(), what.end()); }
void Append(Bytes* to, const std::string& what) { to->insert(to->end(), what.begin(), what.end()); }

std::vector<Bytes> Split(const Bytes& stream, size_t chunk) {
  JpegSplitter splitter;
  std::vector<Bytes> pictures;
  for (size_t from = 0; from < stream.size(); from += chunk) {
    splitter.Add(stream.data() + from, std::min(chunk, stream.size() - from),
                 [&](Bytes jpeg) { pictures.push_back(std::move(jpeg)); });
  }
  return pictures;
}

TEST(JpegSplitter, FindsPicturesWhereverTheBytesAreCut) {
  const std::vector<Bytes> sent{JpegOf(1), JpegOf(2), WithPreview(JpegOf(3), JpegOf(4)), JpegOf(5)};
  Bytes stream;
  for (const Bytes& jpeg : sent) Append(&stream, jpeg);
  for (const size_t chunk : {size_t{1}, size_t{7}, size_t{1000}, stream.size()}) {
    EXPECT_EQ(Split(stream, chunk), sent) << chunk;
  }
}

TEST(JpegSplitter, PassesOverTheHeadersOfAMultipartMessage) {
  const std::vector<Bytes> sent{JpegOf(1), JpegOf(2)};
  Bytes stream;
  for (const Bytes& jpeg : sent) {
    Append(&stream, "--frame\r\nContent-Type: image/jpeg\r\n\r\n");
    Append(&stream, jpeg);
    Append(&stream, "\r\n");
  }
  EXPECT_EQ(Split(stream, 100), sent);
}

TEST(JpegSplitter, GivesAPictureWithItsLastByte) {
  const Bytes jpeg = JpegOf(1);
  JpegSplitter splitter;
  int pictures = 0;
  const auto count = [&](const Bytes&) { ++pictures; };
  splitter.Add(jpeg.data(), jpeg.size() - 1, count);
  EXPECT_EQ(pictures, 0);
  splitter.Add(&jpeg.back(), 1, count);
  EXPECT_EQ(pictures, 1);
}

TEST(JpegSplitter, StartsInTheMiddleOfAPicture) {
  const Bytes first = JpegOf(1), second = JpegOf(2);
  Bytes stream(first.begin() + 500, first.end());
  Append(&stream, second);
  EXPECT_EQ(Split(stream, 64), std::vector<Bytes>{second});
}

}  // namespace
}  // namespace softforce::vision
