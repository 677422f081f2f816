#pragma once

#include "apps/capture/capture.h"

/// What somebody's own pipeline made, read leniently: docs/check.md is the description for its author.
namespace lrsm {

struct CandidateBuffer {
    Buffer buffer;              ///< the golden's description with the candidate's bytes, in the golden's storage
    std::vector<double> given;  ///< the values as the file has them, where it holds another element type; else empty
    std::string file;           ///< where it came from, for people: "lrsm0.dds, mip 3"
    std::string note;           ///< what was done to it: "float32 in the file"; may be empty
};

/// A buffer whose file is there, but cannot be read or does not fit.
struct UnreadableBuffer {
    std::string name;
    std::string why;  ///< "FILE: why; what to do"
};

struct Candidate {
    std::string folder;
    std::vector<CandidateBuffer> buffers;  ///< in the golden's order; those not found are left out
    std::vector<UnreadableBuffer> unreadable;
    std::vector<std::string> nearMisses;  ///< files, layers and map keys that are nearly a buffer's name: a sentence each; they stand in notes, too
    std::vector<std::string> notes;       ///< files that are of no buffer, settings that its manifest has otherwise: a sentence each

    /// nullptr when there is none of this name.
    const CandidateBuffer* find(const std::string& name) const;
    const UnreadableBuffer* findUnreadable(const std::string& name) const;
};

struct CandidateOptions {
    std::string map;                  ///< a JSON file that says where buffers are; empty: by their names alone
    std::vector<std::string> passes;  ///< whose buffers are read; empty: all
};

/// Looks for every buffer of `golden` (whose buffers must have their bytes' descriptions, not the bytes) in the folder: as the map says, else as
/// NAME.npy, an array NAME of an .npz, a DDS, raw NAME.bin, a layer of an EXR, or NAME.png. Other element types are converted to the golden's
/// storage: halves round as the golden's settings say. InputError "FILE: why; what to do" for a bad folder, map or manifest; buffers that cannot be
/// read are listed.
Candidate readCandidate(const std::string& folder, const Capture& golden, const CandidateOptions& options = {});

/// The golden with the candidate's buffers laid over it: what a pass of ours is run anew on. Voxels given in one packing count in both.
Capture layOver(const Capture& golden, const Candidate& candidate);

}  // namespace lrsm
