// GLSL that is added to shaders, as it stands in the .glsl files beside this header. Before it goes into a
// shader, Draft::adapt replaces the prefix `sd_` by one that the shader does not use, and SD_HIGHP by what
// the dialect needs.
#pragma once

namespace shadestep::instrumenter::helpers {

extern const char* const k_accesses;
extern const char* const k_accesses_declarations;
extern const char* const k_accesses_fragment;
extern const char* const k_attachment_halves;
extern const char* const k_es_words;
extern const char* const k_recording_declarations;
extern const char* const k_recording_fragment;
extern const char* const k_recording_functions;
extern const char* const k_recording_thread;
extern const char* const k_switch_selector;

}  // namespace shadestep::instrumenter::helpers
