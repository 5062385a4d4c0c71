// What requests that passed the guard are answered with.
#include "manoscope/core/error.hpp"
#include "manoscope/results/write.hpp"
#include "manoscope/serve/job_api.hpp"
#include "manoscope/serve/test_api.hpp"
#include "tests/support/example_measurement.hpp"

namespace manoscope::serve {
namespace {

TEST_F(ApiTest, StateTellsExperimentsAndResults) {
  write_text(top() / "s1-result/result.nc", "x");
  write_text(top() / "s1-result/report.html", "x");
  const json state = get("/api/state");
  ASSERT_EQ(state["experiments"].size(), 1u);
  EXPECT_EQ(state["experiments"][0]["file"], "s1/experiment.toml");
  EXPECT_EQ(state["experiments"][0]["folder"], "s1");
  EXPECT_EQ(state["experiments"][0]["name"], "small");
  ASSERT_EQ(state["results"].size(), 1u);
  EXPECT_EQ(state["results"][0]["folder"], "s1-result");
  EXPECT_EQ(state["results"][0]["report"], true);
  EXPECT_EQ(state["folder"]["name"], "served");
  EXPECT_TRUE(state["job"].is_null());
}

TEST_F(ApiTest, ListsAFolder) {
  const json list = get("/api/files?folder=s1");
  ASSERT_EQ(list["entries"].size(), 7u);
  EXPECT_EQ(list["entries"][0]["name"], "experiment.toml");
  EXPECT_EQ(list["entries"][0]["map"], false);
  EXPECT_EQ(list["entries"][1]["name"], "f0.gsf");
  EXPECT_EQ(list["entries"][1]["map"], true);
  const json above = get("/api/files");
  EXPECT_EQ(above["entries"][0]["kind"], "folder");
  EXPECT_EQ(above["entries"][0]["experiment"], true);
  get("/api/files?folder=none", 404);
}

TEST_F(ApiTest, ReadsAnExperimentThatIsSound) {
  const json e = experiment();
  EXPECT_EQ(e["text"], kToml);
  EXPECT_EQ(e["lists"]["flow.csv"], kFlow);
  EXPECT_EQ(e["faults"], json::array()) << e["faults"].dump(2);
  EXPECT_EQ(e["hydrostatic_maps"], 3);
  EXPECT_EQ(e["flow_maps"], 1);
  EXPECT_FALSE(e["notes"].empty());  // the height's uncertainty is not given
  EXPECT_EQ(e["form"]["channel"]["length"], "1.2 mm");
  EXPECT_TRUE(e["form"]["channel"]["origin"].is_null());
  EXPECT_TRUE(e["form"]["wall"]["thickness"].is_null());
  EXPECT_EQ(e["form"]["hydrostatic"]["rows"][1], json({"h1.gsf", "500", ""}));
  EXPECT_EQ(e["form"]["comments"]["channel.length"], "CONFIRM: along the flow");
  get("/api/experiment?file=s2/experiment.toml", 404);
}

TEST_F(ApiTest, ChecksADraftAndWritesNothing) {
  json form = experiment()["form"];
  form["channel"]["height"] = "50";
  form["hydrostatic"]["rows"][2][1] = "a lot";
  form["flow"]["rows"][0][0] = "f9.gsf";
  const json checked = check(form);
  EXPECT_EQ(read_text(top() / "s1/experiment.toml"), kToml);
  ASSERT_EQ(checked["faults"].size(), 3u) << checked["faults"].dump(2);
  const json& height = checked["faults"][0];
  EXPECT_EQ(height["key"], "channel.height");
  EXPECT_EQ(height["file"], "s1/experiment.toml");
  EXPECT_EQ(height["line"], 7);
  const json& level = checked["faults"][1];
  EXPECT_EQ(level["key"], "hydrostatic.pressure");
  EXPECT_EQ(level["file"], "s1/hydrostatic.csv");
  EXPECT_EQ(level["row"], 2);
  EXPECT_EQ(level["column"], "pressure");
  const json& map = checked["faults"][2];
  EXPECT_EQ(map["key"], "flow.map");
  EXPECT_EQ(map["row"], 0);
  EXPECT_EQ(map["text"].get<std::string>().find(top().string()), std::string::npos);
}

TEST_F(ApiTest, ReadsTheMapsOnlyWhenAsked) {
  write_text(top() / "s1/h1.gsf", "no map");
  EXPECT_TRUE(check(experiment()["form"])["faults"].empty());
  const json checked =
      post("/api/check",
           {{"file", "s1/experiment.toml"}, {"form", experiment()["form"]}, {"maps", true}});
  EXPECT_EQ(checked["maps_checked"], true);
  ASSERT_EQ(checked["faults"].size(), 1u) << checked.dump(2);
  EXPECT_EQ(checked["faults"][0]["key"], "hydrostatic.map");
  EXPECT_EQ(checked["faults"][0]["row"], 1);
}

TEST_F(ApiTest, TellsWhereATextCeasesToBeToml) {
  const json checked =
      post("/api/check", {{"file", "s1/experiment.toml"}, {"text", "manoscope = 1\n[channel\n"}});
  EXPECT_TRUE(checked["form"].is_null());
  ASSERT_EQ(checked["faults"].size(), 1u);
  EXPECT_EQ(checked["faults"][0]["line"], 2);
}

TEST_F(ApiTest, DraftsAnExperimentFromMaps) {
  write_map(top() / "raw/h_0Pa.gsf", 0.0);
  write_map(top() / "raw/h_500Pa.gsf", 1e-6);
  const json draft = post("/api/experiment/draft", {{"folder", "raw"}}, 201);
  EXPECT_EQ(draft["file"], "raw/experiment.toml");
  EXPECT_EQ(draft["hydrostatic"], json({"h_0Pa.gsf", "h_500Pa.gsf"}));
  EXPECT_EQ(draft["written"][0], "raw/hydrostatic.csv");
  const json e = get("/api/experiment?file=raw/experiment.toml");
  EXPECT_EQ(e["form"]["channel"]["length"], "? mm");
  EXPECT_FALSE(e["faults"].empty());
  post("/api/experiment/draft", {{"folder", "raw"}}, 422);
  post("/api/experiment/draft", {{"folder", "none"}}, 404);
  std::filesystem::create_directories(top() / "linked");
  std::filesystem::create_symlink("../../../etc/passwd", top() / "linked/h_1Pa.gsf");
  post("/api/experiment/draft", {{"folder", "linked"}}, 422);
}

TEST_F(ApiTest, ShowsAMapAndTheDifferenceOfTwo) {
  const json map = get("/api/map?file=s1/h2.gsf&longest=100");
  EXPECT_EQ(map["summary"]["file"], "s1/h2.gsf");
  EXPECT_EQ(map["summary"]["channels"][0]["nx"], 150);
  const json& picture = map["picture"];
  EXPECT_EQ(picture["nx"], 100);
  EXPECT_EQ(picture["ny"], 40);
  EXPECT_NEAR(picture["size_x_m"].get<double>(), 1.5e-3, 1e-12);
  EXPECT_EQ(picture["unit"], "m");
  EXPECT_GT(picture["step"].get<double>(), 0.0);
  // Crest 2 um; means of blocks are a little below, noise of 5 nm is a little above.
  EXPECT_NEAR(picture["max"].get<double>(), 2e-6, 0.1e-6);
  EXPECT_FALSE(picture["counts"].get<std::string>().empty());
  const json flat = get("/api/map?file=s1/h2.gsf&minus=s1/h2.gsf")["picture"];
  EXPECT_EQ(flat["max"], 0.0);
  EXPECT_EQ(flat["min"], 0.0);
  get("/api/map?file=s1/none.gsf", 404);
  get("/api/map?file=s1/flow.csv", 422);
  get("/api/map?file=s1/h2.gsf&pitch_x=5", 422);
}

TEST_F(ApiTest, FindsTheChannelWhateverElseIsAtFault) {
  json form = experiment()["form"];
  form["channel"]["height"] = "? um";
  form["hydrostatic"]["rows"].push_back({"f0.gsf", "?", ""});  // not the lowest level
  const json body = {{"file", "s1/experiment.toml"}, {"form", form}};
  const json place = post("/api/place", body);
  EXPECT_EQ(place["low"], "h0.gsf");
  EXPECT_EQ(place["high"], "h2.gsf");
  EXPECT_EQ(place["found"]["flow"], "+columns");
  EXPECT_EQ(place["found"]["outward"], "+height");
  // Within a pixel of 10 um.
  EXPECT_NEAR(place["frame"]["corners_m"][0][0].get<double>(), 0.15e-3, 1e-5);
  EXPECT_NEAR(place["frame"]["corners_m"][0][1].get<double>(), 0.15e-3, 1e-5);
  EXPECT_NEAR(place["frame"]["corners_m"][2][0].get<double>(), 1.35e-3, 1e-5);
  EXPECT_NEAR(place["frame"]["corners_m"][2][1].get<double>(), 0.45e-3, 1e-5);
  EXPECT_GT(place["frame"]["rim_margin_m"].get<double>(), 0.0);
  // What was found, written into the form, is found there again.
  form["channel"]["origin"] = place["found"]["origin"];
  form["channel"]["flow"] = place["found"]["flow"];
  form["channel"]["outward"] = place["found"]["outward"];
  form["channel"]["rotation"] = place["found"]["rotation"];
  const json again = post("/api/place", {{"file", "s1/experiment.toml"}, {"form", form}});
  EXPECT_EQ(again["found"], place["found"]);
  form["channel"]["length"] = "? mm";
  post("/api/place", {{"file", "s1/experiment.toml"}, {"form", form}}, 422);
}

TEST_F(ApiTest, OrdersAreTheCommandThatAUserWouldType) {
  const Folder folder(top());
  const JobOrder order = order_from(
      folder, "/usr/bin/manoscope",
      R"({"experiment": "s1/experiment.toml", "overwrite": true, "options": {"rim-margin": "50 um"}})");
  EXPECT_EQ(order.output, "s1-result");
  const std::string path = folder.path().string();
  EXPECT_EQ(order.words,
            (std::vector<std::string>{"/usr/bin/manoscope", "measure", path + "/s1/experiment.toml",
                                      "-o", path + "/s1-result", "--progress", "--overwrite",
                                      "--rim-margin=50 um"}));
  for (const char* body :
       {R"({"experiment": "s1/flow.csv"})", R"({"experiment": "s2/experiment.toml"})",
        R"({"experiment": "s1/experiment.toml", "output": "../x"})",
        R"({"experiment": "s1/experiment.toml", "output": "/tmp/x"})",
        R"({"experiment": "s1/experiment.toml", "output": ""})",
        R"({"experiment": "s1/experiment.toml", "options": {"rim-margn": "5 um"}})",
        R"({"experiment": "s1/experiment.toml", "options": {"rim-margin": "5"}})",
        R"({"experiment": "s1/experiment.toml", "options": {"rim-margin": "-5 um"}})",
        R"({"experiment": "s1/experiment.toml", "options": {"output": "x"}})"}) {
    EXPECT_THROW(order_from(folder, "manoscope", body), InputError) << body;
  }
}

TEST_F(ApiTest, ListsTheOptionsOfAJob) {
  const json options = get("/api/options")["measure"];
  const auto named = [&](const std::string& name) {
    for (const json& option : options) {
      if (option["name"] == name) return option;
    }
    return json();
  };
  EXPECT_EQ(named("rim-margin")["value"], "auto");
  EXPECT_EQ(named("interactive")["group"], "Report");
}

TEST_F(ApiTest, HandsOutResultsAndPagesInAnOriginOfTheirOwn) {
  write_text(top() / "r/report.html", "<p>");
  write_text(top() / "r/drops.csv", "a,b");
  write_text(top() / "r/key.pem", "x");
  const auto header = [](const Reply& reply, const std::string& name) {
    for (const auto& [known, value] : reply.headers) {
      if (known == name) return value;
    }
    return std::string();
  };
  const Reply page = ask(Method::get, "/results/r/report.html");
  EXPECT_EQ(page.status, 200u);
  EXPECT_TRUE(page.file);
  EXPECT_EQ(page.file_size, 3u);
  const std::string policy = header(page, "Content-Security-Policy");
  EXPECT_TRUE(policy.starts_with("sandbox allow-scripts")) << policy;
  EXPECT_EQ(policy.find("allow-same-origin"), std::string::npos);
  EXPECT_EQ(header(ask(Method::get, "/results/r/drops.csv?download"), "Content-Disposition"),
            "attachment");
  EXPECT_EQ(ask(Method::get, "/results/r/key.pem").status, 404u);
  EXPECT_EQ(ask(Method::get, "/results/r/none.csv").status, 404u);
}

TEST_F(ApiTest, TellsAResultForComparing) {
  test_support::ExampleSize size;
  size.n_x = 20;
  size.n_levels = 3;
  size.n_runs = 2;
  results::write_result(top() / "r", test_support::example_measurement(size), {});
  const json result = get("/api/result?folder=r");
  EXPECT_EQ(result["output"], "r");
  ASSERT_EQ(result["runs"].size(), 2u);
  EXPECT_EQ(result["x_m"].size(), 20u);
  EXPECT_EQ(result["runs"][1]["pressure_Pa"].size(), 20u);
  EXPECT_TRUE(result["runs"][0].contains("extracted_drop_Pa"));
  get("/api/result?folder=s1", 404);
  write_text(top() / "bad/result.nc", "no netcdf");
  get("/api/result?folder=bad", 422);
}

}  // namespace
}  // namespace manoscope::serve
