// Makes an element: h("button.small", { type: "button", onclick: go }, "Go"). Text children are never read as HTML.
"use strict";
{
  const setProperty = (element, name, value) => {
    if (value === undefined || value === null || value === false) return;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "style" && typeof value === "object") {
      for (const [key, text] of Object.entries(value)) element.style.setProperty(key, text);
    } else element.setAttribute(name, value === true ? "" : value);
  };

  const make = (element, properties, children) => {
    for (const [name, value] of Object.entries(properties ?? {})) setProperty(element, name, value);
    for (const child of children.flat(Infinity)) {
      if (child !== undefined && child !== null && child !== false) element.append(child);
    }
    return element;
  };

  review.h = (selector, properties, ...children) => {
    const [tag, ...classes] = selector.split(".");
    const element = document.createElement(tag);
    element.classList.add(...classes);
    return make(element, properties, children);
  };

  // Allows line breaks after the separators in a name.
  review.breakable = (name) => name.split(/(?<=[/_.-])/).flatMap((part) => [part, document.createElement("wbr")]);

  review.svg = (tag, attributes, ...children) =>
    make(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}
