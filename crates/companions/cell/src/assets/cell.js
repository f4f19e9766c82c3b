// Names stay within this function.
(() => {
    /** Data of the page: the picture, and places at times in equal steps. */
    const cell = JSON.parse(document.getElementById("cell").textContent);

    const main = document.querySelector("main");
    main.innerHTML = `<header><h1></h1><p class="status"></p></header><figure>${cell.svg}</figure>`;
    main.querySelector("h1").textContent = cell.name;
    const status = /** @type {HTMLElement} */ (main.querySelector(".status"));
    status.textContent = cell.result;
    status.dataset.ending = cell.ending;

    /** Draws the arms at a time, and lets the reader choose the time. */
    function play() {
        const { duration, places, arms } = cell.motion;
        const svg = main.querySelector("svg");
        svg.setAttribute("role", "img");
        svg.setAttribute("aria-label", "Both arms in the cell, the diagram of their times, and a row of time for each arm");
        const element = (name, attributes, parent) => {
            const made = document.createElementNS("http://www.w3.org/2000/svg", name);
            for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
            return parent.appendChild(made);
        };
        const links = arms.map(({ color, links }) => links.map((paths) => {
            const group = element("g", { fill: `var(--${color})`, stroke: `var(--${color})`, opacity: 0.85, "stroke-linejoin": "round", "stroke-linecap": "round" }, svg);
            for (const { d, width } of paths) element("path", { d, "stroke-width": width }, group);
            return group;
        }));
        const line = element("path", { stroke: "var(--ink)", "stroke-width": 1.5 }, svg);
        const dot = element("circle", { r: 7, fill: "var(--ink)", stroke: "var(--paper)", "stroke-width": 2 }, svg);
        const clock = document.createElement("div");
        clock.className = "clock";
        clock.innerHTML = `<button type="button" class="button">Play</button>
            <input type="range" min="0" max="${places.length - 1}" value="0" aria-label="Time of both arms">
            <output></output>`;
        main.append(clock);
        const [button, , output] = clock.children;
        const slider = clock.querySelector("input");
        const show = () => {
            const place = places[slider.value];
            const time = (duration * +slider.value) / (places.length - 1);
            links.forEach((own, arm) => own.forEach((group, link) => group.setAttribute("transform", `matrix(${place.links[arm][link]})`)));
            dot.setAttribute("cx", place.diagram[0]);
            dot.setAttribute("cy", place.diagram[1]);
            line.setAttribute("d", `M${place.row[0]},${place.row[1]}V${place.row[2]}`);
            output.textContent = `${time.toFixed(3)} s`;
            slider.setAttribute("aria-valuetext", output.textContent);
        };
        let begun = null;
        const stop = () => {
            begun = null;
            button.textContent = "Play";
        };
        const step = (now) => {
            if (begun === null) return;
            const index = Math.round(((now - begun) / 1000 / duration) * (places.length - 1));
            slider.value = String(Math.min(Math.max(index, 0), places.length - 1));
            show();
            if (index >= places.length - 1) stop();
            else requestAnimationFrame(step);
        };
        button.addEventListener("click", () => {
            if (begun !== null) return stop();
            const from = +slider.value === places.length - 1 ? 0 : +slider.value;
            begun = performance.now() - (from / (places.length - 1)) * duration * 1000;
            button.textContent = "Pause";
            requestAnimationFrame(step);
        });
        slider.addEventListener("input", () => {
            stop();
            show();
        });
        // In the diagram and in the rows, the nearest place of the schedule follows the pointer.
        const [left, top, right, bottom] = cell.motion.frame;
        const [from, to] = [places[0].row[0], places[places.length - 1].row[0]];
        const chosen = (event) => {
            const view = svg.viewBox.baseVal;
            const shown = svg.getBoundingClientRect();
            const x = ((event.clientX - shown.left) / shown.width) * view.width;
            const y = ((event.clientY - shown.top) / shown.height) * view.height;
            if (x >= left && x <= right && y >= top && y <= bottom) {
                const far = places.map(({ diagram: [a, b] }) => Math.hypot(a - x, b - y));
                return far.indexOf(Math.min(...far));
            }
            const [, above, below] = places[0].row;
            return y >= above && y <= below && x >= from && x <= to ? Math.round(((x - from) / (to - from)) * (places.length - 1)) : null;
        };
        let isDown = false;
        const move = (event) => {
            const index = chosen(event);
            svg.classList.toggle("drag", index !== null);
            if (!isDown || index === null) return;
            stop();
            slider.value = String(index);
            show();
        };
        svg.addEventListener("pointerdown", (event) => {
            isDown = true;
            move(event);
        });
        svg.addEventListener("pointermove", move);
        addEventListener("pointerup", () => (isDown = false));
        show();
    }

    if (cell.motion) play();
})();
