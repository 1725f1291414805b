#pragma once

/// Cameras (GigE Vision, USB3 Vision, V4L2, replays) and their recordings (docs/capture.md):
///
///     for (const stipple::CameraListing& camera : stipple::list_cameras().cameras)
///         std::cout << camera.address << ": " << camera.model << "\n";
///
/// CameraRecorder records a camera, CaptureSession gives its frames one by one, RecordingReader
/// reads a recording, and LiveEmulator sends a camera's frames through an emulated sensor.
#include "capture/camera_search.h"
#include "capture/capture_session.h"
#include "capture/live_emulator.h"
#include "capture/open_camera.h"
#include "capture/recording/camera_recorder.h"
#include "capture/recording/recording_reader.h"
