#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace softforce::scene::testing {

// A folder of the running test's own.
std::filesystem::path TempFolder();

// Writes `text` and returns the file's path.
std::filesystem::path WriteFile(const std::filesystem::path& path, const std::string& text);

// `text` with its one occurrence of `from` replaced; fails the test if there is not exactly one.
std::string Replaced(std::string text, const std::string& from, const std::string& to);

// A small scene with all that a scene can have, and a two-camera rig.
extern const char* const kSceneText;
extern const char* const kActuationText;
extern const char* const kRigText;

// Puts a scene.yaml into TempFolder() beside all files that kSceneText names, and returns its path.
std::filesystem::path WriteScene(const std::string& scene_text,
                                 const std::string& actuation_text = kActuationText);

// The message with which `load` refuses a file, without the folder; fails the test if it does not.
std::string Refusal(const std::function<void()>& load);

// The message with which the program refuses kSceneText after `from` has been replaced by `to`.
std::string SceneRefusal(const std::string& from, const std::string& to);

// The same for a changed actuation table, and a changed rig file.
std::string ActuationRefusal(const std::string& actuation_text);
std::string RigRefusal(const std::string& from, const std::string& to);

}  // namespace softforce::scene::testing
