#pragma once

#include <apriltag.h>

#include <string>

#include "softforce/vision/tag_cells.h"

namespace softforce::vision {

// How a tag stands upright is a matter of convention: OpenCV draws the classic families turned by
// half a turn against AprilTag's own pictures. OpenCV's way holds here; families that it does not
// draw stand as AprilTag draws them.
struct FamilyMaker {
  const char* name;
  bool turned_by_opencv;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

// Throws InputError, naming `where`, for an unknown family.
const FamilyMaker& MakerOf(const std::string& family, const std::string& where = "tag family");

// The family with so many cells of black around its codes, where AprilTag has one. To be destroyed
// by `maker`.
apriltag_family_t* CreateFamily(const FamilyMaker& maker, int black_border);

// A tag of that family, see DrawTag; the id must be one of its own.
TagCells CellsOf(const FamilyMaker& maker, apriltag_family_t* family, int id);

}  // namespace softforce::vision
