//! A tab with the page in it, and everything that a visitor can do to it.

use super::browser::{Backend, Browser, Lease, PATIENCE, served};
use super::picture::Picture;
use base64::{Engine, engine::general_purpose::STANDARD};
use serde_json::{Value, json};
use sinew::clock;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The screen that the page is shown on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// 1440 × 900, a mouse.
    Desktop,
    /// 960 × 640, a mouse: for what does not depend on the size, because drawing without a graphics card is slow.
    Small,
    /// The same for a visitor who wants little motion and nothing transparent: for what does not depend on it, because
    /// nothing is drawn then while nothing happens, and nothing blurred behind the controls.
    Still,
    /// 390 × 844 at two device pixels to a CSS pixel, touch.
    Phone,
    /// A tablet held upright.
    Tablet,
    /// A small phone that lies on its side.
    Lying,
}

/// The page in a tab of its own. Closing it (dropping it) fails the test if the page had problems.
pub struct Page {
    lease: Lease,
    backend: Backend,
    screen: Screen,
    /// The context of the tab, if it has one of its own.
    context: Option<String>,
    target: String,
    session: String,
    /// The tab's session and those of its workers.
    sessions: BTreeSet<String>,
    address: String,
    /// When the test got its place, and when it last asked for the page.
    begun: f64,
    opened: f64,
    problems: Vec<String>,
    expected: Vec<String>,
    log: Vec<String>,
}

impl Page {
    /// Opens the page with `tail` (`?query#hash`, or nothing) after its address.
    pub fn open(backend: Backend, screen: Screen, tail: &str) -> Self {
        Self::open_at(served(), backend, screen, tail)
    }

    /// The same for what measures time: no other page is open meanwhile, and nothing is left of those before, as if the
    /// visitor came for the first time.
    pub fn open_alone(backend: Backend, screen: Screen, tail: &str) -> Self {
        Self::open_in(Lease::take(true), true, served(), backend, screen, tail)
    }

    /// Opens another page: `tail` after the given address.
    pub fn open_at(address: String, backend: Backend, screen: Screen, tail: &str) -> Self {
        Self::open_in(Lease::take(false), false, address, backend, screen, tail)
    }

    fn open_in(mut lease: Lease, fresh: bool, address: String, backend: Backend, screen: Screen, tail: &str) -> Self {
        let begun = clock::seconds();
        let browser = lease.place.browser(backend);
        let context =
            fresh.then(|| text(&browser.call("Target.createBrowserContext", json!({}), None)["browserContextId"]));
        let (target, session) = browser.open_tab(context.as_deref());
        let sessions = BTreeSet::from([session.clone()]);
        let (problems, expected, log) = (Vec::new(), Vec::new(), Vec::new());
        let mut page = Self {
            lease,
            begun,
            backend,
            screen,
            context,
            target,
            session,
            sessions,
            address,
            opened: 0.0,
            problems,
            expected,
            log,
        };
        page.call("Page.enable", json!({}));
        if !fresh && page.address == served() {
            // Every file twice over, from the server to the service worker and from there to the page, is not their subject.
            page.call("Network.enable", json!({}));
            page.call("Network.setBypassServiceWorker", json!({ "bypass": true }));
        }
        page.resize(screen);
        page.go(tail);
        page
    }

    /// Loads the page again with another tail after its address.
    pub fn go(&mut self, tail: &str) {
        self.opened = clock::seconds();
        let url = format!("{}{tail}", self.address);
        let answer = self.call("Page.navigate", json!({ "url": url }));
        if let Some(error) = answer["errorText"].as_str() {
            panic!("{url} does not open: {error}");
        }
    }

    /// Seconds since the page was asked for.
    pub fn seconds(&self) -> f64 {
        clock::seconds() - self.opened
    }

    /// Shows the page on another screen.
    pub fn resize(&mut self, screen: Screen) {
        self.screen = screen;
        let (width, height, scale, phone) = match screen {
            Screen::Desktop => (1440, 900, 1, false),
            Screen::Small | Screen::Still => (960, 640, 1, false),
            Screen::Phone => (390, 844, 2, true),
            Screen::Tablet => (820, 1180, 1, true),
            Screen::Lying => (667, 375, 1, true),
        };
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": scale, "mobile": phone });
        self.call("Emulation.setDeviceMetricsOverride", metrics);
        self.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": phone, "maxTouchPoints": 5 }));
        if screen == Screen::Still {
            self.prefer(&[("prefers-reduced-motion", "reduce"), ("prefers-reduced-transparency", "reduce")]);
        }
    }

    /// Sets media features, such as `("prefers-color-scheme", "dark")` or `("prefers-reduced-motion", "reduce")`.
    pub fn prefer(&mut self, features: &[(&str, &str)]) {
        let features: Vec<_> = features.iter().map(|(name, value)| json!({ "name": name, "value": value })).collect();
        self.call("Emulation.setEmulatedMedia", json!({ "features": features }));
    }

    /// The value of a JavaScript expression, as JSON; a promise is awaited. An exception fails the test.
    pub fn evaluate(&mut self, expression: &str) -> Value {
        self.evaluate_within(expression, PATIENCE)
    }

    /// The same for what may take long.
    pub fn evaluate_within(&mut self, expression: &str, seconds: f64) -> Value {
        match self.try_evaluate(expression, seconds) {
            Ok(value) => value,
            Err(error) => self.fail(&format!("`{expression}`: {error}")),
        }
    }

    /// The state that the page shows to tests.
    pub fn state(&mut self) -> Value {
        self.evaluate("sinew.state()")
    }

    /// Waits until a JavaScript expression is true (one that throws is not), and returns how many seconds after the
    /// page was asked for that was. The test fails after `seconds` of waiting, with a screenshot.
    pub fn wait_until(&mut self, condition: &str, seconds: f64) -> f64 {
        let deadline = clock::seconds() + seconds;
        loop {
            let answer = self.try_evaluate(&format!("Boolean({condition})"), PATIENCE);
            if answer == Ok(Value::Bool(true)) {
                return self.seconds();
            }
            if clock::seconds() > deadline {
                let last = self.try_evaluate("window.sinew ? sinew.state() : 'there is no window.sinew'", PATIENCE);
                self.fail(&format!("`{condition}` did not come true in {seconds} s; the state: {last:?}"));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Lets the page run for some seconds.
    pub fn rest(&mut self, seconds: f64) {
        let end = clock::seconds() + seconds;
        loop {
            // Not a plain sleep: a worker that starts meanwhile waits until it is listened to.
            let left = end - clock::seconds();
            if left <= 0.0 {
                return;
            }
            self.listen(left.min(0.05));
        }
    }

    /// Drags files from outside the browser onto the middle of the page and drops them there.
    pub fn drop_files(&mut self, files: &[(&str, &[u8])]) {
        let paths = write_files(files, self.lease.place.number());
        let (x, y) = self.middle_of("html");
        let data = json!({ "items": [], "files": paths, "dragOperationsMask": 1 });
        for kind in ["dragEnter", "dragOver", "drop"] {
            self.call("Input.dispatchDragEvent", json!({ "type": kind, "x": x, "y": y, "data": data }));
        }
    }

    /// Chooses files in an `<input type="file">`.
    pub fn choose_files(&mut self, selector: &str, files: &[(&str, &[u8])]) {
        let paths = write_files(files, self.lease.place.number());
        let find = json!({ "expression": format!("document.querySelector({})", json!(selector)) });
        let found = self.call("Runtime.evaluate", find);
        let Some(object) = found["result"]["objectId"].as_str() else { self.fail(&format!("there is no {selector}")) };
        let object = object.to_owned();
        self.call("DOM.setFileInputFiles", json!({ "files": paths, "objectId": object }));
    }

    /// Clicks (taps, on a phone) in the middle of an element. Another element in the way fails the test.
    pub fn click(&mut self, selector: &str) {
        let (x, y) = self.middle_of(selector);
        let reachable = format!(
            "(() => {{ const hit = document.elementFromPoint({x}, {y}), aim = document.querySelector({});
            return aim.contains(hit) || Boolean(hit && [...(aim.labels ?? [])].some(l => l.contains(hit))); }})()",
            json!(selector)
        );
        if self.evaluate(&reachable) != Value::Bool(true) {
            self.fail(&format!("{selector} cannot be clicked: something lies over it, or it is out of sight"));
        }
        match self.screen {
            Screen::Desktop | Screen::Small | Screen::Still => {
                self.mouse("mouseMoved", x, y, 0);
                self.mouse("mousePressed", x, y, 1);
                self.mouse("mouseReleased", x, y, 0);
            }
            Screen::Phone | Screen::Tablet | Screen::Lying => {
                self.call(
                    "Input.dispatchTouchEvent",
                    json!({ "type": "touchStart", "touchPoints": [{ "x": x, "y": y }] }),
                );
                self.call("Input.dispatchTouchEvent", json!({ "type": "touchEnd", "touchPoints": [] }));
            }
        }
    }

    /// Moves the mouse to a point of an element: (0, 0) is its top left, (1, 1) its bottom right.
    pub fn hover(&mut self, selector: &str, at: (f64, f64)) {
        let [left, top, width, height] = self.box_of(selector);
        self.mouse("mouseMoved", left + at.0 * width, top + at.1 * height, 0);
    }

    /// Presses the mouse in the middle of an element, moves it by some CSS pixels and lets it go.
    pub fn drag(&mut self, selector: &str, by: (f64, f64)) {
        let from = self.middle_of(selector);
        self.drag_from(from, by);
    }

    /// The same from a point of the page.
    pub fn drag_from(&mut self, (x, y): (f64, f64), by: (f64, f64)) {
        self.mouse("mouseMoved", x, y, 0);
        self.mouse("mousePressed", x, y, 1);
        for step in 1..=8 {
            let share = f64::from(step) / 8.0;
            self.mouse("mouseMoved", x + by.0 * share, y + by.1 * share, 1);
        }
        self.mouse("mouseReleased", x + by.0, y + by.1, 0);
    }

    /// Turns the wheel over the middle of an element, by CSS pixels.
    pub fn wheel(&mut self, selector: &str, pixels: f64) {
        let (x, y) = self.middle_of(selector);
        let turn = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": pixels });
        self.call("Input.dispatchMouseEvent", turn);
    }

    /// Presses and lets go of a key, by its `KeyboardEvent.key` (`"Escape"`, `"ArrowLeft"`, `" "`, `"a"`).
    pub fn press(&mut self, key: &str) {
        let code = match key {
            "Tab" => 9,
            "Enter" => 13,
            "Escape" => 27,
            " " => 32,
            "PageUp" => 33,
            "PageDown" => 34,
            "End" => 35,
            "Home" => 36,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            "Delete" => 46,
            one => one.bytes().next().map_or(0, |byte| byte.to_ascii_uppercase().into()),
        };
        let typed = if key == "Enter" { Some("\r") } else { (key.chars().count() == 1).then_some(key) };
        let name = if key == " " { "Space" } else { key };
        let mut down = json!({ "type": "rawKeyDown", "key": key, "code": name, "windowsVirtualKeyCode": code });
        if let Some(typed) = typed {
            down["type"] = json!("keyDown");
            down["text"] = json!(typed);
        }
        self.call("Input.dispatchKeyEvent", down);
        let up = json!({ "type": "keyUp", "key": key, "code": name, "windowsVirtualKeyCode": code });
        self.call("Input.dispatchKeyEvent", up);
    }

    /// Presses and lets go of a letter while Control is held.
    pub fn press_with_control(&mut self, key: &str) {
        let code = key.bytes().next().map_or(0, |byte| u32::from(byte.to_ascii_uppercase()));
        for kind in ["rawKeyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "modifiers": 2, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// What the page looks like, also written to `target/screenshots/NAME-BACKEND-SCREEN.png`.
    pub fn screenshot(&mut self, name: &str) -> Picture {
        let quickly = json!({ "format": "png", "optimizeForSpeed": true });
        let answer = self.call("Page.captureScreenshot", quickly);
        let png = STANDARD.decode(text(&answer["data"])).expect("the browser writes base64");
        let screen = match self.screen {
            Screen::Desktop => "desktop",
            Screen::Small | Screen::Still => "small",
            Screen::Phone => "phone",
            Screen::Tablet => "tablet",
            Screen::Lying => "lying",
        };
        let folder = screenshots();
        let path = folder.join(format!("{name}-{}-{screen}.png", self.backend.name()));
        let written = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(path, &png));
        written.expect("the folder of screenshots can be written");
        Picture::from_png(&png)
    }

    /// The part of a screenshot that shows an element.
    pub fn picture_of(&mut self, selector: &str, name: &str) -> Picture {
        let scale = self.evaluate("devicePixelRatio").as_f64().unwrap_or(1.0);
        let [left, top, width, height] = self.box_of(selector).map(|length| (length.max(0.0) * scale) as usize);
        self.screenshot(name).cut(left, top, width, height)
    }

    /// Looks at an element until another share of it, from 0 to 1, is to be seen than in an earlier picture of it: a busy
    /// machine shows a frame some time after it was drawn.
    pub fn wait_until_changed(&mut self, selector: &str, name: &str, before: &Picture, share: f64) {
        let deadline = clock::seconds() + 10.0;
        loop {
            let changed = self.picture_of(selector, name).difference(before, 8);
            if changed > share {
                return;
            }
            if clock::seconds() > deadline {
                self.fail(&format!("{name}: only {:.3} % of {selector} changed", 100.0 * changed));
            }
            self.rest(0.4);
        }
    }

    /// Lets the problems that contain some words pass.
    pub fn expect_problem(&mut self, words: &str) {
        self.expected.push(words.to_owned());
    }

    /// The problems so far: everything on the console that is an error, everything uncaught or refused, and every
    /// request to another host.
    pub fn problems(&mut self) -> Vec<String> {
        self.listen(0.0);
        let expected = |problem: &String| !self.expected.iter().any(|words| problem.contains(words));
        self.problems.iter().filter(|problem| expected(problem)).cloned().collect()
    }

    /// Left, top, width and height of an element in CSS pixels, scrolled into sight.
    fn box_of(&mut self, selector: &str) -> [f64; 4] {
        let rectangle = self.evaluate(&format!(
            "(() => {{ const e = document.querySelector({}); if (!e) return null;
            e.scrollIntoViewIfNeeded?.(); const r = e.getBoundingClientRect();
            return [r.left, r.top, r.width, r.height]; }})()",
            json!(selector)
        ));
        let Some(numbers) = rectangle.as_array() else { self.fail(&format!("there is no {selector}")) };
        std::array::from_fn(|i| numbers[i].as_f64().unwrap_or_default())
    }

    fn middle_of(&mut self, selector: &str) -> (f64, f64) {
        let [left, top, width, height] = self.box_of(selector);
        (left + width / 2.0, top + height / 2.0)
    }

    fn mouse(&mut self, kind: &str, x: f64, y: f64, buttons: u32) {
        let button = if kind == "mouseMoved" && buttons == 0 { "none" } else { "left" };
        let count = u32::from(kind != "mouseMoved");
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": count });
        self.call("Input.dispatchMouseEvent", event);
    }

    fn try_evaluate(&mut self, expression: &str, seconds: f64) -> Result<Value, String> {
        let parameters = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let session = self.session.clone();
        let answer = self.browser().try_call("Runtime.evaluate", parameters, Some(&session), seconds);
        self.listen(0.0);
        let mut answer = answer?;
        match answer.get("exceptionDetails") {
            Some(details) => Err(exception(details)),
            None => Ok(answer["result"]["value"].take()),
        }
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        let session = self.session.clone();
        self.browser().call(method, parameters, Some(&session))
    }

    fn browser(&mut self) -> &mut Browser {
        self.lease.place.browser(self.backend)
    }

    /// How to close the tab, with its context if that is its own.
    fn closing(&self) -> (&'static str, Value) {
        match &self.context {
            Some(context) => ("Target.disposeBrowserContext", json!({ "browserContextId": context })),
            None => ("Target.closeTarget", json!({ "targetId": self.target })),
        }
    }

    /// Sorts what has happened, or happens first within some seconds, into problems and the rest.
    fn listen(&mut self, seconds: f64) {
        for event in self.browser().events(seconds) {
            // What comes from a tab closed before is not ours.
            let ours = event["sessionId"].as_str().is_some_and(|session| self.sessions.contains(session));
            let parameters = &event["params"];
            let started = text(&parameters["sessionId"]);
            let attached = event["method"] == "Target.attachedToTarget";
            if attached && (ours || started == self.session) {
                self.sessions.insert(started);
            }
            if ours && let Some(line) = describe(&event["method"], parameters, &self.address) {
                match line {
                    Heard::Problem(line) => self.problems.push(line),
                    Heard::Word(line) => self.log.push(line),
                }
            }
        }
    }

    /// Fails the test with a screenshot and all that is known.
    fn fail(&mut self, reason: &str) -> ! {
        let test = std::thread::current().name().unwrap_or("page").replace("::", "-");
        let screen = self.screenshot(&format!("failed-{test}"));
        let problems = self.problems();
        panic!(
            "{reason}\nproblems: {problems:#?}\nconsole: {:#?}\nthe {}-pixel-wide screen is in {}",
            self.log,
            screen.width,
            screenshots().display()
        );
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        eprintln!("the page was open for {:.1} s", clock::seconds() - self.begun);
        if std::thread::panicking() {
            // The first failure is the one to report; the tab only has to go.
            let (method, parameters) = self.closing();
            self.browser().send(method, parameters, None);
            return;
        }
        let problems = self.problems();
        let (method, parameters) = self.closing();
        self.browser().call(method, parameters, None);
        assert!(problems.is_empty(), "the page had problems: {problems:#?}\nconsole: {:#?}", self.log);
    }
}

/// What an event says.
enum Heard {
    Problem(String),
    Word(String),
}

fn describe(method: &Value, event: &Value, address: &str) -> Option<Heard> {
    match method.as_str()? {
        "Runtime.exceptionThrown" => Some(Heard::Problem(exception(&event["exceptionDetails"]))),
        "Runtime.consoleAPICalled" => {
            let words = event["args"].as_array()?.iter().map(|word| match &word["value"] {
                Value::Null => text(&word["description"]),
                Value::String(value) => value.clone(),
                value => value.to_string(),
            });
            let line = words.collect::<Vec<_>>().join(" ");
            let wrong = matches!(event["type"].as_str(), Some("error" | "assert"));
            Some(if wrong { Heard::Problem(line) } else { Heard::Word(line) })
        }
        // What the browser itself says: policies violated, files not found, a context lost.
        "Log.entryAdded" => {
            let entry = &event["entry"];
            let line = format!("{} {}", text(&entry["text"]), text(&entry["url"]));
            Some(if entry["level"] == "error" { Heard::Problem(line) } else { Heard::Word(line) })
        }
        "Network.requestWillBeSent" => {
            let url = text(&event["request"]["url"]);
            let host = address.split('/').take(3).collect::<Vec<_>>().join("/") + "/";
            let local = [host.as_str(), "data:", "blob:", "about:"].iter().any(|start| url.starts_with(start));
            (!local).then(|| Heard::Problem(format!("asked another host for {url}")))
        }
        "Inspector.targetCrashed" => Some(Heard::Problem("the page crashed".to_owned())),
        _ => None,
    }
}

fn exception(details: &Value) -> String {
    let thrown = &details["exception"];
    let what = thrown["description"].as_str().map_or_else(|| thrown["value"].to_string(), str::to_owned);
    format!("{}: {what} ({}:{})", text(&details["text"]), text(&details["url"]), details["lineNumber"])
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// Where screenshots are kept.
fn screenshots() -> PathBuf {
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    scratch.parent().unwrap_or(scratch).join("screenshots")
}

/// Writes files where the browser can take them from.
fn write_files(files: &[(&str, &[u8])], place: usize) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("dropped-{place}"));
    std::fs::create_dir_all(&folder).expect("the scratch folder can be written");
    let write = |(name, bytes): &(&str, &[u8])| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("the scratch folder can be written");
        path
    };
    files.iter().map(write).collect()
}
