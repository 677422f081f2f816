#pragma once

#include "apps/capture/capture.h"
#include "core/base/output_folder.h"

/// A capture's folder: manifest.json, one .npy a buffer, DDS where a buffer names one.
namespace lrsm {

/// Equal captures give equal bytes.
void writeCapture(OutputFolder& folder, const Capture& capture);

/// What the capture in `folder` consists of, pictures apart, by its manifest; nothing where there is none that can be read.
std::vector<std::string> filesOfCapture(const std::string& folder);

/// Bytes of the .npy and DDS that writeCapture will write; of the buffers only their description counts.
std::size_t predictCaptureBytes(const std::vector<Buffer>& buffers);

/// Strict: every buffer that the manifest names must be there, of its shape and type, and have its SHA-256. InputError "FILE: why; what to do".
Capture readCapture(const std::string& folder);

/// The manifest alone: buffers without bytes.
Capture readManifest(const std::string& folder);

}  // namespace lrsm
