#include "apps/common/preview.h"

#include "apps/common/sequence.h"
#include "core/base/text.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <sstream>
#include <vector>

extern char** environ;

namespace lrsm {
namespace {

namespace fs = std::filesystem;

/// Runs a program of the PATH inside `folder`, its output unseen; false where there is none, or it fails.
bool runInside(const std::string& folder, std::vector<std::string> words)
{
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    for (const int stream : {1, 2}) posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    int status = -1;
    const bool started = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    return started && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string numberOf(double value)
{
    std::ostringstream text;
    text << value;
    return text.str();
}

/// H.264 as every player reads it wants even edges.
std::vector<std::string> ffmpegWords(const PreviewRange& range, const std::string& pictures, const std::string& file)
{
    return {"ffmpeg",
            "-y",
            "-framerate",
            numberOf(range.fps),
            "-start_number",
            std::to_string(range.begin),
            "-i",
            pictures,
            "-frames:v",
            std::to_string(range.end - range.begin),
            "-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2",
            "-pix_fmt",
            "yuv420p",
            file};
}

std::string millisecondsOf(const PreviewRange& range)
{
    return std::to_string(int(1000.0 / range.fps + 0.5));
}

}  // namespace

std::string makePreview(const std::string& folder, const PreviewRange& range)
{
    std::vector<std::string> webp = {"img2webp", "-d", millisecondsOf(range)};
    for (int i = range.begin; i < range.end; ++i) webp.push_back(frameName(i) + "/image.png");
    // With one's own partial file as output: half a film never has the name of a whole one.
    for (const std::string& name : std::vector<std::string>{"preview.mp4", "preview.webp"}) {
        const std::string partial = ".partial-" + name;
        std::vector<std::string> words = webp;
        words.insert(words.end(), {"-o", partial});
        if (name == "preview.mp4") words = ffmpegWords(range, "%04d/image.png", partial);
        const bool made = runInside(folder, words);
        std::error_code error;
        if (made) fs::rename(fs::path(folder) / partial, fs::path(folder) / name, error);
        if (made && !error) return name;
        fs::remove(fs::path(folder) / partial, error);
    }
    return "";
}

std::string previewHint(const std::string& folder, const PreviewRange& range)
{
    std::string ffmpeg;
    for (const std::string& word : ffmpegWords(range, folder + "/%04d/image.png", folder + "/preview.mp4")) {
        const std::string quote = word.find_first_of(" (*") == std::string::npos ? "" : "'";  // as a shell reads it
        ffmpeg += (ffmpeg.empty() ? "" : " ") + quote + word + quote;
    }
    return ffmpeg + ", or img2webp -d " + millisecondsOf(range) + " " + folder + "/*/image.png -o " + folder + "/preview.webp";
}

}  // namespace lrsm
