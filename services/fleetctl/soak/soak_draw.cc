#include "services/fleetctl/soak/soak_draw.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/gnuplot.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// Removed at scope exit, whatever happens.
class PassingFile {
 public:
  explicit PassingFile(fs::path path) : path_(std::move(path)) {}
  ~PassingFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;
  std::string Path() const { return path_.string(); }

 private:
  fs::path path_;
};

// Empty if it was drawn, else the reason.
std::string DrawOne(const SoakPlot& plot, const fs::path& folder,
                    std::vector<DrawnSoakPlot>* drawn) {
  const PassingFile program(folder / (plot.name + ".gnuplot"));
  const PassingFile svg(folder / (plot.name + ".svg"));
  WriteFile(program.Path(), "set output " + GnuplotQuoted(svg.Path()) + "\n" + plot.program);
  std::string complaint = RunGnuplot(program.Path());
  if (!complaint.empty()) return complaint;
  drawn->push_back({plot.name, plot.title, ReadWholeFile(svg.Path()).value_or("")});
  return "";
}

}  // namespace

std::vector<DrawnSoakPlot> Draw(const std::vector<SoakPlot>& plots, const std::string& folder) {
  std::vector<DrawnSoakPlot> drawn;
  try {
    for (const SoakPlot& plot : plots) {
      const std::string why_not = DrawOne(plot, folder, &drawn);
      if (why_not.empty()) continue;
      std::fprintf(stderr, "no picture '%s': %s\n", plot.title.c_str(), why_not.c_str());
      if (why_not == kGnuplotIsMissing) break;
    }
  } catch (const OutputError& error) {
    std::fprintf(stderr, "no pictures: %s\n", error.what());
  } catch (const StartError& error) {
    std::fprintf(stderr, "no pictures: %s\n", error.what());
  }
  return drawn;
}

void WriteSoakPage(const SoakResult& result, const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  WriteFile(file, ToHtml(result, Draw(PlotsOf(result), folder.empty() ? "." : folder.string())));
}

void WriteSoakReport(const SoakResult& result, const std::string& folder) {
  const fs::path place(folder);
  WriteFile((place / "report.json").string(), ToJson(result) + "\n");
  WriteSoakPage(result, (place / "report.html").string());
}

}  // namespace giveway::fleetctl
