// What is written of a draft, and what its names may lead to.
#include "manoscope/core/error.hpp"
#include "manoscope/serve/job_api.hpp"
#include "manoscope/serve/test_api.hpp"

namespace manoscope::serve {
namespace {

TEST_F(ApiTest, WritesInPlaceAndOnlyWhatDiffers) {
  json e = experiment();
  e["form"]["channel"]["length"] = "1.3 mm";
  e["form"]["wall"]["thickness"] = "0.2 um";
  e["form"]["hydrostatic"]["rows"][1][1] = "510";
  const json written = put({{"form", e["form"]}}, e["revision"]);
  std::string toml = kToml;
  toml.replace(toml.find("1.2 mm"), 6, "1.3 mm");
  EXPECT_EQ(read_text(top() / "s1/experiment.toml"), toml + "\n[wall]\nthickness = \"0.2 um\"\n");
  std::string list = kHydrostatic;
  list.replace(list.find("500"), 3, "510");
  EXPECT_EQ(read_text(top() / "s1/hydrostatic.csv"), list);
  EXPECT_NE(written["revision"], e["revision"]);
  EXPECT_EQ(written["form"]["wall"]["thickness"], "0.2 um");
}

TEST_F(ApiTest, WritesNothingOverWhatChangedInTheMeantime) {
  const json e = experiment();
  for (const char* file : {"experiment.toml", "flow.csv"}) {
    const std::string before = read_text(top() / "s1" / file);
    write_text(top() / "s1" / file, before + "# by an editor\n");
    const json answer = put({{"form", e["form"]}}, e["revision"], 412);
    EXPECT_TRUE(answer.contains("error"));
    EXPECT_NE(answer["experiment"]["revision"], e["revision"]);
    write_text(top() / "s1" / file, before);
  }
  put({{"form", e["form"]}}, e["revision"]);
  const Reply reply =
      ask(Method::put, "/api/experiment?file=s1/experiment.toml", {{"form", e["form"]}});
  EXPECT_EQ(reply.status, 428u);
}

TEST_F(ApiTest, MakesANewExperimentAndNewLists) {
  const json form = {{"name", "new"},
                     {"hydrostatic",
                      {{"file", "levels.csv"},
                       {"columns", {"map", "pressure [Pa]"}},
                       {"rows", json::array({{"../s1/h0.gsf", "0"}})}}}};
  const std::string target = "/api/experiment?file=s2/experiment.toml";
  Reply reply = ask(Method::put, target, {{"form", form}}, "", "*");
  EXPECT_EQ(reply.status, 201u) << reply.body;
  EXPECT_EQ(read_text(top() / "s2/experiment.toml"),
            "manoscope = 1\nname = \"new\"\n\n[hydrostatic]\nlist = \"levels.csv\"\n");
  EXPECT_EQ(read_text(top() / "s2/levels.csv"), "map,pressure [Pa]\n../s1/h0.gsf,0\n");
  reply = ask(Method::put, target, {{"form", form}}, "", "*");
  EXPECT_EQ(reply.status, 412u);
}

TEST_F(ApiTest, ANewListReplacesNoFile) {
  json e = experiment();
  write_text(top() / "s1/mine.csv", "my table");
  e["form"]["flow"]["file"] = "mine.csv";
  put({{"form", e["form"]}}, e["revision"], 409);
  EXPECT_EQ(read_text(top() / "s1/mine.csv"), "my table");
  for (const char* name : {"../../out.csv", "/tmp/out.csv", "f0.gsf", "../.out.csv"}) {
    e["form"]["flow"]["file"] = name;
    put({{"form", e["form"]}}, e["revision"], 422);
  }
  EXPECT_EQ(experiment()["revision"], e["revision"]);
}

TEST_F(ApiTest, NamesThatLeadOutAreFaultsAndAreNotOpened) {
  write_text(outer / "secret.csv", "map,flow_rate [mL/min]\nsecret word,x\n");
  json e = experiment();
  e["form"]["flow"]["rows"][0][0] = "../../secret.csv";
  json checked = check(e["form"]);
  ASSERT_EQ(checked["faults"].size(), 1u);
  EXPECT_EQ(checked["faults"][0]["key"], "flow.map");
  EXPECT_EQ(checked["faults"][0]["row"], 0);
  std::string toml = kToml;
  toml.replace(toml.find("flow.csv"), 8, "../../secret.csv");
  checked = post("/api/check", {{"file", "s1/experiment.toml"}, {"text", toml}});
  ASSERT_EQ(checked["faults"].size(), 1u);
  EXPECT_EQ(checked["faults"][0]["key"], "flow.list");
  EXPECT_EQ(checked.dump().find("secret word"), std::string::npos);
  std::filesystem::create_symlink(outer / "secret.csv", top() / "s1/link.csv");
  toml = kToml;
  toml.replace(toml.find("flow.csv"), 8, "link.csv");
  checked = post("/api/check", {{"file", "s1/experiment.toml"}, {"text", toml}});
  ASSERT_EQ(checked["faults"].size(), 1u);
  EXPECT_EQ(checked.dump().find("secret word"), std::string::npos);
}

TEST_F(ApiTest, HiddenFilesAreNotShownByTheirNameInAnExperiment) {
  write_text(top() / "s1/.ssh/id_rsa", "secret word");
  write_text(top() / "s1/key.pem", "secret word");
  for (const char* name : {".ssh/id_rsa", "key.pem"}) {
    const std::string toml = "manoscope = 1\n[flow]\nlist = \"" + std::string(name) + "\"\n";
    const json checked = post("/api/check", {{"file", "s1/x.toml"}, {"text", toml}});
    EXPECT_EQ(checked.dump().find("secret"), std::string::npos);
    ASSERT_EQ(checked["faults"].size(), 1u) << checked["faults"].dump(2);
    EXPECT_EQ(checked["faults"][0]["key"], "flow.list");
  }
  json e = experiment();
  write_text(top() / "s1/.f0.gsf", "secret word");
  e["form"]["flow"]["rows"][0][0] = ".f0.gsf";
  const json checked = check(e["form"]);
  ASSERT_EQ(checked["faults"].size(), 1u);
  EXPECT_EQ(checked["faults"][0]["key"], "flow.map");
}

TEST_F(ApiTest, NothingIsMeasuredOrPlacedThatLeadsOut) {
  const Folder folder(top());
  const std::string body = R"({"experiment": "s1/experiment.toml"})";
  EXPECT_NO_THROW(order_from(folder, "manoscope", body));
  write_map(outer / "other/x.gsf", 2e-6);
  std::filesystem::create_directories(outer / "other/deep");
  std::filesystem::create_directory_symlink(outer / "other/deep", top() / "s1/out");
  for (const std::string& name : {(outer / "other/x.gsf").string(),
                                  std::string("../../other/x.gsf"), std::string("out/../x.gsf")}) {
    write_text(top() / "s1/flow.csv", "map,flow_rate [mL/min]\n" + name + ",5\n");
    EXPECT_THROW(order_from(folder, "manoscope", body), InputErrors) << name;
    EXPECT_EQ(experiment()["faults"].size(), 1u) << name;
    json form = experiment()["form"];
    form["flow"] = nullptr;
    form["hydrostatic"]["rows"][2][0] = name;
    post("/api/place", {{"file", "s1/experiment.toml"}, {"form", form}}, 422);
    EXPECT_EQ(check(form)["faults"][0]["key"], "hydrostatic.map") << name;
  }
}

TEST_F(ApiTest, AListThatIsThereAlreadyIsTakenAsItIs) {
  const std::string levels = "# mine\nmap;flow_rate [mL/min]\nf0.gsf;7\n";
  write_text(top() / "s1/mine.csv", levels);
  // By the text, where its content was shown.
  json e = experiment();
  std::string toml = kToml;
  toml.replace(toml.find("flow.csv"), 8, "mine.csv");
  e = put({{"text", toml}}, e["revision"]);
  EXPECT_EQ(e["form"]["flow"]["rows"], json::array({{"f0.gsf", "7"}}));
  const json mine = e["form"]["flow"];
  // By the form with the same table, and by one without rows.
  for (const bool empty : {false, true}) {
    e = put({{"text", kToml}}, e["revision"]);
    e["form"]["flow"] = mine;
    if (empty) e["form"]["flow"]["rows"] = json::array();
    e = put({{"form", e["form"]}}, e["revision"]);
    EXPECT_EQ(e["form"]["flow"], mine);
    EXPECT_EQ(read_text(top() / "s1/mine.csv"), levels);
  }
  // One that is no sound table is shown as what it is.
  write_text(top() / "s1/bad.csv", "map,run\na\n");
  e["form"]["flow"]["file"] = "bad.csv";
  e["form"]["flow"]["rows"] = json::array();
  e = put({{"form", e["form"]}}, e["revision"]);
  EXPECT_FALSE(e["form"]["flow"]["locked"].is_null());
  EXPECT_FALSE(e["faults"].empty());
}

TEST_F(ApiTest, AFieldThatIsEmptiedAndFilledKeepsItsCommentAndPlace) {
  json e = experiment();
  e["form"]["channel"]["length"] = nullptr;
  json written = put({{"form", e["form"]}}, e["revision"]);
  EXPECT_NE(
      written["text"].get<std::string>().find("# length =   # CONFIRM: along the flow\nwidth"),
      std::string::npos);
  written["form"]["channel"]["length"] = "1.2 mm";
  put({{"form", written["form"]}}, written["revision"]);
  EXPECT_EQ(read_text(top() / "s1/experiment.toml"), kToml);
}

TEST_F(ApiTest, TellsInWordsWhatIsOfAnotherKind) {
  for (const json& body :
       {json{{"file", 5}}, json{{"file", "a.toml"}, {"form", {{"channel", {{"length", 5}}}}}},
        json{{"file", "a.toml"}, {"form", {{"channel", 5}}}},
        json{{"file", "a.toml"}, {"form", {{"flow", 5}}}},
        json{{"file", "a.toml"}, {"form", {{"flow", {{"columns", json::array()}}}}}},
        json{{"file", "a.toml"}, {"form", {{"flow", {{"columns", 5}, {"rows", 5}}}}}},
        json{{"file", "a.toml"}, {"form", {{"flow", {{"columns", json::array()}, {"rows", {5}}}}}}},
        json{{"file", "a.toml"}, {"text", ""}, {"lists", 5}},
        json{{"file", "a.toml"}, {"text", ""}, {"maps", "yes"}}}) {
    const json answer = post("/api/check", body, 400);
    const std::string found = answer["error"]["found"];
    EXPECT_EQ(found.find("json"), std::string::npos) << found;
    EXPECT_NE(found.find(" is not "), std::string::npos) << found;
  }
}

}  // namespace
}  // namespace manoscope::serve
